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

#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/run.hpp"
#include "core/base/warnings.hpp"
#include "core/geometry/place_text.hpp"
#include "core/geometry/subset.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/time_limit.hpp"
#include "raw/solids/hidden_bends.hpp"
#include "raw/solids/hidden_walls.hpp"
#include "raw/solids/unseen_side.hpp"

namespace cloud2csg {
namespace {

using PointLists = std::vector<std::span<const std::uint32_t>>;

PointLists lists_of(std::span<const SurfacePoints> known) {
  PointLists lists;
  for (const SurfacePoints& own : known) lists.emplace_back(own.points);
  return lists;
}

PointLists lists_of(const RestDetection& found) {
  PointLists lists = lists_of(found.known);
  for (const DetectedSurface& surface : found.detection.surfaces) lists.emplace_back(surface.points);
  return lists;
}

/// Indices below `count` that are in none of the lists, ascending.
std::vector<std::uint32_t> points_of_none(const PointLists& lists, std::size_t count) {
  std::vector<bool> is_taken(count, false);
  for (const std::span<const std::uint32_t> own : lists) {
    for (const std::uint32_t i : own) is_taken[i] = true;
  }
  return places_where(is_taken, false);
}

/// How many points lie on the surface, with its normal.
std::size_t count_points_on(const Surface& surface, const PointCloud& cloud, std::size_t first_points,
                            double tolerance) {
  constexpr double k_least_cosine = 0.9;
  std::size_t count = 0;
  for (std::size_t i = 0; i < first_points; ++i) {
    const Eigen::Vector3d place = cloud.positions[i];
    const bool is_near = std::abs(signed_distance(surface, place)) <= tolerance;
    count += is_near && normal(surface, place).dot(cloud.normals[i]) > k_least_cosine ? 1 : 0;
  }
  return count;
}

/// Adds points to the cloud, which a surface takes, and notes that it closes what nobody saw.
void add_points(FoundPrimitives& found, const PointCloud& points, DetectedSurface& surface, Unseen reason) {
  PointCloud& cloud = found.prepared.cloud;
  const std::size_t own = cloud.size() - found.added.size();
  const std::size_t seen =
      surface.points.empty()
          ? count_points_on(surface.surface, cloud, own, found.detection.distance_tolerance)
          : static_cast<std::size_t>(std::ranges::count_if(surface.points, [&](std::uint32_t i) { return i < own; }));
  found.closed.push_back({.reason = reason,
                          .type = surface.surface.type,
                          .place = bounds_of(points.positions).center(),
                          .added_points = points.size(),
                          .seen = share(seen, seen + points.size())});
  const auto before = static_cast<std::ptrdiff_t>(surface.points.size());
  surface.points.resize(surface.points.size() + points.size());
  std::iota(surface.points.begin() + before, surface.points.end(), static_cast<std::uint32_t>(cloud.size()));
  append(found.added, points);
  append(cloud, points);
  found.areas.clear();
}

/// Removes the added points from the cloud: what follows judges by the cloud's own points.
void take_back_added(FoundPrimitives& found) {
  if (found.added.size() == 0) return;
  PointCloud& cloud = found.prepared.cloud;
  std::vector<std::uint32_t> own(cloud.size() - found.added.size());
  std::iota(own.begin(), own.end(), 0U);
  cloud = select_points(cloud, own);
  for (DetectedSurface& surface : found.detection.surfaces) {
    std::erase_if(surface.points, [&](std::uint32_t i) { return i >= own.size(); });
  }
}

void close_unseen_side(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  found.areas = point_areas(cloud, run);
  const std::optional<UnseenSide> side =
      find_unseen_side(cloud, found.areas, found.detection.surfaces, found.prepared.scale, run);
  if (!side) return;
  const auto close = [&](const PointCloud& points, Unseen reason) {
    DetectedSurface plane{.surface = {.position = points.positions[0], .axis = side->normal}, .points = {}};
    add_points(found, points, plane, reason);
    found.detection.surfaces.push_back(std::move(plane));
  };
  close(side->points, Unseen::side);
  for (const PointCloud& underside : side->undersides) close(underside, Unseen::underside);
  // Rounded, and + 0.0 turns -0 into 0.
  const Eigen::Array3d facing = (1000 * side->normal.array()).round() / 1000 + 0.0;
  found.warnings.push_back(fmt::format(
      "the side facing ({:.3g}, {:.3g}, {:.3g}), {:.2g} % of the surface, has no points and was closed by "
      "a plane through {}",
      facing.x(), facing.y(), facing.z(), 100 * side->share,
      place_text(found.origin + bounds_of(side->points.positions).center(), found.prepared.scale.diagonal)));
  if (side->undersides.empty()) return;
  found.warnings.push_back(fmt::format(
      "the underside of {} overhang{}, the largest near {}, has no points and was closed where the walls around it end",
      side->undersides.size(), side->undersides.size() == 1 ? "" : "s",
      place_text(found.origin + bounds_of(side->undersides[0].positions).center(), found.prepared.scale.diagonal)));
}

/// Adds the insides of bends. They replace surfaces that were made of pieces of them.
void close_hidden_bends(FoundPrimitives& found, const RunContext& run) {
  std::vector<DetectedSurface>& surfaces = found.detection.surfaces;
  const std::vector<HiddenBend> bends = find_hidden_bends(found.prepared.cloud, surfaces, found.prepared.scale, run);
  if (bends.empty()) return;
  for (const auto& [inside, hidden] : bends) {
    const std::vector<std::uint32_t>& own = inside.points;
    for (DetectedSurface& other : surfaces) {
      const std::size_t before = other.points.size();
      std::erase_if(other.points, [&](std::uint32_t i) { return std::ranges::binary_search(own, i); });
      if (2 * other.points.size() >= before) continue;
      found.detection.unexplained += other.points.size();
      other.points.clear();
    }
    std::erase_if(surfaces, [](const DetectedSurface& other) { return other.points.empty(); });
    add_points(found, hidden, surfaces.emplace_back(inside), Unseen::bend);
  }
  const auto largest = std::ranges::max_element(bends, {}, [](const HiddenBend& bend) { return bend.hidden.size(); });
  found.warnings.push_back(fmt::format(
      "no sensor saw far into {} of the bends, the largest near {}: their walls were taken to be as thick all along",
      bends.size(),
      place_text(found.origin + bounds_of(largest->hidden.positions).center(), found.prepared.scale.diagonal)));
}

/// Adds hidden walls to the cloud, and their points to the surfaces.
void close_hidden_walls(FoundPrimitives& found, const RunContext& run) {
  const std::vector<HiddenWall> walls =
      find_hidden_walls(found.prepared.cloud, found.detection.surfaces, found.prepared.scale,
                        found.prepared.cloud.size() - found.added.size(), run);
  if (walls.empty()) return;
  const auto largest = std::ranges::max_element(walls, {}, &HiddenWall::area);
  const Eigen::Vector3d middle = bounds_of(largest->points.positions).center();
  for (const HiddenWall& wall : walls) {
    add_points(found, wall.points, found.detection.surfaces[wall.surface], Unseen::wall);
  }
  found.warnings.push_back(
      fmt::format("no sensor saw far into {} of the holes, the largest near {}: their walls were taken to go on",
                  walls.size(), place_text(found.origin + middle, found.prepared.scale.diagonal)));
}

/// Adds points and surfaces where no sensor saw the part, with warnings. Precondition: the surfaces are detected.
FoundPrimitives with_unseen_closed(FoundPrimitives found, const RunContext& run) {
  close_unseen_side(found, run);
  close_hidden_bends(found, run);
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

/// Leaves out the doubted points that are on no surface and on no known primitive, which are outliers, and those beside
/// smoothed edges.
std::pair<PreparedCloud, RestDetection> without_outliers(PreparedCloud prepared, RestDetection rest) {
  const std::vector<std::uint32_t> doubted = std::exchange(prepared.doubted, {});
  const std::size_t count = prepared.cloud.size();
  const std::vector<std::uint32_t> smoothed = std::exchange(rest.detection.smoothed, {});
  std::vector<std::uint32_t> candidates;
  std::ranges::set_union(doubted, smoothed, std::back_inserter(candidates));
  std::vector<std::uint32_t> outliers;
  std::ranges::set_intersection(candidates, points_of_none(lists_of(rest), count), std::back_inserter(outliers));
  if (outliers.empty()) return {std::move(prepared), std::move(rest)};
  std::vector<std::uint32_t> place(count);
  auto next = outliers.begin();
  for (std::uint32_t i = 0; i < count; ++i) {
    place[i] = i - static_cast<std::uint32_t>(next - outliers.begin());
    if (next != outliers.end() && *next == i) ++next;
  }
  const auto move = [&place](std::vector<std::uint32_t>& points) {
    for (std::uint32_t& i : points) i = place[i];
  };
  for (DetectedSurface& surface : rest.detection.surfaces) move(surface.points);
  for (SurfacePoints& known : rest.known) move(known.points);
  prepared.cloud = without_points(prepared.cloud, outliers);
  prepared.cleaning.smoothed = smoothed.size();
  prepared.cleaning.off_surface += outliers.size() - smoothed.size();
  rest.detection.unexplained -= outliers.size();
  return {std::move(prepared), std::move(rest)};
}

/// @throws Error without surfaces and without points on known primitives
void check_any_surface(const RestDetection& found, const PointCloud& cloud) {
  if (!found.detection.surfaces.empty() || count_of(found.known) > 0) return;
  throw Error(
      {.expected = fmt::format("no plane, sphere, cylinder, cone or torus explains enough of the {} points "
                               "within {:.3g}",
                               cloud.size(), found.detection.distance_tolerance),
       .remedy = "give a larger `detection.distance_tolerance`, or a cloud of an object made of such surfaces"});
}

PreparedCloud prepare_in_frame(const PointCloud& cloud, const Eigen::Vector3d& origin, const PrepareOptions& options,
                               const RunContext& run) {
  if (origin.isZero(0)) return prepare_cloud(cloud, options, run);
  return prepare_cloud(seen_from(cloud, origin), options, run);
}

std::vector<KnownSolid> known_solids(const PrimitiveSet& known, std::vector<SurfacePoints> own) {
  std::vector<KnownSolid> solids;
  for (std::size_t k = 0; k < known.size(); ++k) solids.push_back({.solid = known[k], .own = std::move(own[k])});
  return solids;
}

/// Chooses the solids. Without an inside, or without a new or known solid, only the known ones are left, and no tree.
void choose(FoundPrimitives& found, std::span<const KnownSolid> known, const ReconstructOptions& options,
            const RunContext& run) {
  SolidOptions solids = options.solids;
  if (!solids.regularity.given_tolerance) solids.regularity.given_tolerance = found.detection.distance_tolerance;
  try {
    found.choice = choose_solids(found.prepared.cloud, found.detection.surfaces, known, solids, run, found.areas);
  } catch (const NoInside& error) {
    found.no_solid = error;
    for (const KnownSolid& one : known) found.choice.solids.push_back(one.solid);
    return;
  }
  if (!found.choice.solids.empty()) return;
  run.throw_if_stopped();  // no solid so far tells nothing
  found.no_solid =
      Error({.expected = fmt::format("the {} detected surfaces in a cloud of {} points bound no solid",
                                     found.detection.surfaces.size(), found.prepared.cloud.size()),
             .remedy = "give a cloud of some thousand points that covers most of the surface of a closed object"});
}

/// What follows detection.
FoundPrimitives with_solids(FoundPrimitives found, RestDetection rest, const PrimitiveSet& known,
                            const ReconstructOptions& options, Stopwatch& watch, const RunContext& run) {
  check_any_surface(rest, found.prepared.cloud);
  found.unexplained = points_of_none(lists_of(rest), found.prepared.cloud.size());
  found.detection = std::move(rest.detection);
  // Planes show the noise better than neighbours, unless detection has seen only a part of the cloud.
  if (known.empty()) found.prepared.scale.noise = found.detection.noise;
  // Known primitives have ends of their own.
  if (options.close_unseen && known.empty()) found = with_unseen_closed(std::move(found), run);
  found.detect_seconds = watch.lap();

  run.report("solids", 0, 0);
  choose(found, known_solids(known, std::move(rest.known)), options, run);
  take_back_added(found);
  append(found.warnings, found.choice.warnings);
  // An early stop of the choice still leaves a tree.
  add_evidence(found, options.detection, without_stop(run));
  found.choose_seconds = watch.lap();
  return found;
}

/// find_primitives() without warnings about known primitives.
FoundPrimitives find_all(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  check_known(options.known);
  Stopwatch watch;
  FoundPrimitives found;
  found.origin = frame_origin(cloud.positions);
  const PrimitiveSet known = seen_from(options.known, found.origin);
  found.prepared = prepare_in_frame(cloud, found.origin, options.preparation, run);
  watch.lap();
  found.warnings = found.prepared.warnings;
  append(found.warnings, normals_warnings(found.prepared, found.origin));

  const std::optional<double>& tolerance = options.detection.distance_tolerance;
  if (tolerance) append(found.warnings, tolerance_warnings(*tolerance, found.prepared.scale));
  RestDetection all = detect_rest(found.prepared.cloud, found.prepared.scale, known, options.detection, run);
  if (!options.preparation.clean.remove_outliers) all.detection.smoothed.clear();
  auto [prepared, rest] = without_outliers(std::move(found.prepared), std::move(all));
  found.prepared = std::move(prepared);
  append(found.warnings, outlier_warnings(found.prepared.cleaning, cloud.size()));
  const std::vector<std::string> warnings = found.warnings;
  return with_warnings(warnings, [&, &detected = rest] {
    return with_solids(std::move(found), std::move(detected), known, options, watch, run);
  });
}

}  // namespace

RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                          const DetectOptions& options, const RunContext& run) {
  if (known.empty()) return {.known = {}, .detection = detect_surfaces(cloud, scale, options, run)};
  RestDetection result{.known = deal_points(cloud, known, tolerances_of(options, scale), run), .detection = {}};
  const std::vector<std::uint32_t> rest = points_of_none(lists_of(result.known), cloud.size());
  if (rest.empty()) {
    result.detection.noise = scale.noise;
    result.detection.distance_tolerance = detection_tolerance(options, scale);
    return result;
  }
  result.detection = detect_surfaces(select_points(cloud, rest), scale, options, run);
  for (DetectedSurface& surface : result.detection.surfaces) {
    for (std::uint32_t& i : surface.points) i = rest[i];
  }
  for (std::uint32_t& i : result.detection.smoothed) i = rest[i];
  return result;
}

FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  const std::optional<double>& seconds = options.extraction.time_limit_seconds;
  const TimeLimit limit(run.stop, seconds);
  const Stopwatch watch;
  try {
    FoundPrimitives found = find_all(cloud, options, limit.limited(run));
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
                               .smoothed_points = found.prepared.cleaning.smoothed,
                               .closed = found.closed,
                               .added_points = found.added.size(),
                               .normals_estimated = found.prepared.normals_estimated,
                               .diagonal = scale.diagonal,
                               .spacing = scale.spacing,
                               .noise = scale.noise,
                               .tolerance = found.detection.distance_tolerance,
                               .known = known,
                               .known_points = count_of(std::span(found.points).first(known)),
                               .unexplained_points = found.detection.unexplained,
                               .snaps = found.choice.snaps,
                               .rounds = found.choice.rounds};
  for (const DetectedSurface& s : found.detection.surfaces) statistics.surfaces.push_back(s.surface.type);
  return statistics;
}

}  // namespace cloud2csg
