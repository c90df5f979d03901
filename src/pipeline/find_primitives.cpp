#include "pipeline/find_primitives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/run.hpp"
#include "core/geometry/place_text.hpp"
#include "core/geometry/subset.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/time_limit.hpp"
#include "raw/solids/unseen_surfaces.hpp"

namespace cloud2csg {
namespace {

/// Indices of the cloud's points on no known primitive.
std::vector<std::uint32_t> points_of_none(const std::vector<SurfacePoints>& known, std::size_t count) {
  std::vector<bool> is_taken(count, false);
  for (const SurfacePoints& own : known) {
    for (const std::uint32_t i : own.points) is_taken[i] = true;
  }
  return places_where(is_taken, false);
}

void close_unseen_side(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  const std::optional<UnseenSide> side = find_unseen_side(cloud, found.detection.surfaces, found.prepared.scale, run);
  if (!side) return;
  DetectedSurface plane{.surface = {.position = side->points.positions[0], .axis = side->normal}, .points = {}};
  plane.points.resize(side->points.size());
  std::iota(plane.points.begin(), plane.points.end(), static_cast<std::uint32_t>(cloud.size()));
  found.added_points += side->points.size();
  append(cloud, side->points);
  found.detection.surfaces.push_back(std::move(plane));
  // Rounded, and + 0.0 turns -0 into 0.
  const Eigen::Array3d facing = (1000 * side->normal.array()).round() / 1000 + 0.0;
  found.warnings.push_back(
      fmt::format("the side facing ({:.3g}, {:.3g}, {:.3g}), {:.0f} % of the surface, has no points and was closed by "
                  "a plane through {}",
                  facing.x(), facing.y(), facing.z(), 100 * side->share,
                  place_text(bounds_of(side->points.positions).center(), found.prepared.scale.diagonal)));
}

/// Adds hidden walls to the cloud, and their points to the surfaces.
void close_hidden_walls(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  const std::vector<HiddenWall> walls = find_hidden_walls(cloud, found.detection.surfaces, found.prepared.scale, run);
  if (walls.empty()) return;
  const auto largest = std::ranges::max_element(walls, {}, &HiddenWall::area);
  const Eigen::Vector3d middle = bounds_of(largest->points.positions).center();
  for (const HiddenWall& wall : walls) {
    std::vector<std::uint32_t>& own = found.detection.surfaces[wall.surface].points;
    own.resize(own.size() + wall.points.size());
    std::iota(own.end() - static_cast<std::ptrdiff_t>(wall.points.size()), own.end(),
              static_cast<std::uint32_t>(cloud.size()));
    found.added_points += wall.points.size();
    append(cloud, wall.points);
  }
  found.warnings.push_back(
      fmt::format("no sensor saw far into {} of the holes, the largest near {}: their walls were extended between the "
                  "parts that were seen",
                  walls.size(), place_text(middle, found.prepared.scale.diagonal)));
}

/// Adds points and surfaces where no sensor saw the part, with warnings. Precondition: the surfaces are detected.
FoundPrimitives with_unseen_closed(FoundPrimitives found, const RunContext& run) {
  close_unseen_side(found, run);
  close_hidden_walls(found, run);
  return found;
}

void check_known(const PrimitiveSet& known) {
  std::set<std::string> ids;
  for (const Primitive& primitive : known) {
    const std::string where = fmt::format("known primitive '{}'", primitive.id);
    if (!ids.insert(primitive.id).second) {
      throw Error({.where = where, .expected = "another known primitive has the same id"});
    }
    try {
      validate(primitive);
    } catch (const Error& error) {
      Error::Parts parts = error.parts();
      parts.where = where + ": " + parts.where;
      throw Error(std::move(parts));
    }
  }
}

/// The tolerances of detection as those of a segmentation.
SegmentationTolerances tolerances_of(const DetectOptions& options, const Scale& scale) {
  return {.distance = detection_tolerance(options, scale),
          .cosine = std::cos(options.angle_tolerance_deg * std::numbers::pi / 180)};
}

void add_evidence(FoundPrimitives& found, const DetectOptions& options, const RunContext& run) {
  PrimitiveSet& solids = found.choice.solids;
  found.points = deal_points(found.prepared.cloud, solids, tolerances_of(options, found.prepared.scale), run);
  for (std::size_t k = 0; k < solids.size(); ++k) {
    solids[k].evidence = Evidence{.points = found.points[k].points.size(), .rms = found.points[k].rms};
  }
}

/// Leaves out the doubted points that are on no surface and on no known primitive: they are outliers.
std::pair<PreparedCloud, RestDetection> without_doubted(PreparedCloud prepared, RestDetection rest) {
  std::vector<bool> is_outlier(prepared.cloud.size(), false);
  for (const std::uint32_t i : prepared.doubted) is_outlier[i] = true;
  const auto for_each_list = [&rest](const auto& function) {
    for (DetectedSurface& surface : rest.detection.surfaces) function(surface.points);
    for (SurfacePoints& known : rest.known) function(known.points);
  };
  for_each_list([&](const std::vector<std::uint32_t>& points) {
    for (const std::uint32_t i : points) is_outlier[i] = false;
  });
  const std::vector<std::uint32_t> kept = places_where(is_outlier, false);
  std::vector<std::uint32_t> place(is_outlier.size());
  for (std::uint32_t k = 0; k < kept.size(); ++k) place[kept[k]] = k;
  const std::size_t outliers = is_outlier.size() - kept.size();
  prepared.doubted.clear();
  if (outliers == 0) return {std::move(prepared), std::move(rest)};
  for_each_list([&](std::vector<std::uint32_t>& points) {
    for (std::uint32_t& i : points) i = place[i];
  });
  prepared.cloud = select_points(prepared.cloud, kept);
  prepared.cleaning.off_surface += outliers;
  rest.detection.unexplained -= outliers;
  return {std::move(prepared), std::move(rest)};
}

/// find_primitives() without warnings about known primitives.
FoundPrimitives find_all(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  check_known(options.known);
  Stopwatch watch;
  FoundPrimitives found;
  found.prepared = prepare_cloud(cloud, options.preparation, run);
  watch.lap();
  found.warnings = found.prepared.warnings;

  const std::optional<double>& tolerance = options.detection.distance_tolerance;
  if (tolerance) append(found.warnings, tolerance_warnings(*tolerance, found.prepared.scale.diagonal));
  RestDetection all = detect_rest(found.prepared.cloud, found.prepared.scale, options.known, options.detection, run);
  auto [prepared, rest] = without_doubted(std::move(found.prepared), std::move(all));
  found.prepared = std::move(prepared);
  append(found.warnings, outlier_warnings(found.prepared.cleaning, cloud.size()));
  append(found.warnings, detection_warnings(rest, found.prepared));
  found.detection = std::move(rest.detection);
  // Known primitives have ends of their own.
  if (options.close_unseen && options.known.empty()) found = with_unseen_closed(std::move(found), run);
  found.detect_seconds = watch.lap();

  run.report("solids", 0, 0);
  std::vector<KnownSolid> known;
  for (std::size_t k = 0; k < options.known.size(); ++k) {
    known.push_back({.solid = options.known[k], .own = std::move(rest.known[k])});
  }
  SolidOptions solids = options.solids;
  if (!solids.regularity.given_tolerance) solids.regularity.given_tolerance = found.detection.distance_tolerance;
  found.choice = choose_solids(found.prepared.cloud, found.detection.surfaces, known, solids, run);
  if (found.choice.solids.empty()) {
    throw Error({.expected = fmt::format("the {} detected surfaces in a cloud of {} points bound no solid",
                                         found.detection.surfaces.size(), found.prepared.cloud.size()),
                 .remedy = "give a cloud of some thousand points that covers most of the surface of a closed object"});
  }
  append(found.warnings, found.choice.warnings);
  // An early stop of the choice still leaves a tree.
  add_evidence(found, options.detection, without_stop(run));
  found.choose_seconds = watch.lap();
  return found;
}

}  // namespace

RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                          const DetectOptions& options, const RunContext& run) {
  if (known.empty()) return {.known = {}, .detection = detect_surfaces(cloud, scale, options, run)};
  RestDetection result{.known = deal_points(cloud, known, tolerances_of(options, scale), run), .detection = {}};
  const std::vector<std::uint32_t> rest = points_of_none(result.known, cloud.size());
  if (rest.empty()) {
    result.detection.distance_tolerance = detection_tolerance(options, scale);
    return result;
  }
  result.detection = detect_surfaces(select_points(cloud, rest), scale, options, run);
  for (DetectedSurface& surface : result.detection.surfaces) {
    for (std::uint32_t& i : surface.points) i = rest[i];
  }
  return result;
}

FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  const std::optional<double>& seconds = options.extraction.time_limit_seconds;
  const TimeLimit limit(run.stop, seconds);
  RunContext limited = run;
  limited.stop = limit.token();
  const Stopwatch watch;
  try {
    FoundPrimitives found = find_all(cloud, options, limited);
    if (seconds && *seconds <= watch.seconds()) {
      found.warnings.emplace_back("the time limit ended the choice of solids: these are the best so far");
    }
    return found;
  } catch (const Cancelled&) {
    if (run.stop.stop_requested()) throw;
    throw invalid_option("extraction.time_limit_seconds", "the time limit ended before primitives were found",
                         "allow more time, or give a `point_budget` below the number of points");
  }
}

FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t known, std::size_t raw_points) {
  const Scale& scale = found.prepared.scale;
  FindingStatistics statistics{.raw_points = raw_points,
                               .added_points = found.added_points,
                               .normals_estimated = found.prepared.normals_estimated,
                               .diagonal = scale.diagonal,
                               .spacing = scale.spacing,
                               .noise = scale.noise,
                               .tolerance = found.detection.distance_tolerance,
                               .known = known,
                               .known_points = count_of(std::span(found.points).first(known)),
                               .unexplained_points = found.detection.unexplained,
                               .snaps = found.choice.snaps};
  for (const DetectedSurface& s : found.detection.surfaces) statistics.surfaces.push_back(s.surface.type);
  return statistics;
}

}  // namespace cloud2csg
