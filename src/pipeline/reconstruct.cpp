#include "cloud2csg/reconstruct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "base/stopwatch.hpp"
#include "base/without_stop.hpp"
#include "cloud2csg/error.hpp"
#include "pipeline/bare_surface.hpp"
#include "pipeline/fit.hpp"
#include "pipeline/time_limit.hpp"
#include "solids/unseen_side.hpp"

namespace cloud2csg {
namespace {

constexpr double k_much_unexplained = 0.1;
constexpr double k_much_disagreement = 0.1;
constexpr double k_much_bare_surface = 0.05;
constexpr double k_bare_spacings = 6;  ///< as far from all points, a surface is bare

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

void check_detection(const Detection& detection, const PointCloud& cloud, std::vector<std::string>& warnings) {
  if (detection.surfaces.empty()) {
    throw Error({.file = {},
                 .where = {},
                 .expected = fmt::format("no plane, sphere, cylinder, cone or torus explains enough of the {} points "
                                         "within {:.3g}",
                                         cloud.size(), detection.distance_tolerance),
                 .remedy = "give a larger --tolerance, or a cloud of an object made of such surfaces"});
  }
  const double unexplained = share(detection.unexplained, cloud.size());
  if (unexplained > k_much_unexplained) {
    warnings.push_back(
        fmt::format("{:.0f} % of the points lie on no surface that was found: a larger tolerance than "
                    "{:.3g} may help, or these parts are of free form",
                    100 * unexplained, detection.distance_tolerance));
  }
}

FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t raw_points) {
  const Scale& scale = found.prepared.scale;
  FindingStatistics statistics{.raw_points = raw_points,
                               .added_points = found.added_points,
                               .normals_estimated = found.prepared.normals_estimated,
                               .diagonal = scale.diagonal,
                               .spacing = scale.spacing,
                               .noise = scale.noise,
                               .tolerance = found.detection.distance_tolerance,
                               .unexplained_points = found.detection.unexplained,
                               .snaps = found.choice.snaps.size()};
  for (const DetectedSurface& s : found.detection.surfaces) {
    ++statistics.surfaces[static_cast<std::size_t>(s.surface.type)];
  }
  for (const Snap& snap : found.choice.snaps) {
    double& largest = snap.kind == RegularityKind::direction ? statistics.largest_turn_deg : statistics.largest_shift;
    largest = std::max(largest, snap.change);
  }
  return statistics;
}

/// What a tree costs: wrong places, and leaves.
double cost_of(const CsgTree& tree, const SolidChoice& choice, const SolidOptions& options) {
  return disagreement(tree, choice.solids, choice.places) + options.leaf_cost * static_cast<double>(leaf_count(tree));
}

/// The smallest tree over the chosen solids that the points bear out; or that of the choice, when it costs less.
Extraction extract_over(const SolidChoice& choice, const PreparedCloud& prepared, const ReconstructOptions& options,
                        const RunContext& run) {
  ExtractOptions extraction = options.extraction;
  if (!extraction.segmentation.distance_tolerance) {
    extraction.segmentation.distance_tolerance = detection_tolerance(options.detection, prepared.scale);
  }
  // There is a tree already to fall back on: no need to search partitions where the cells' is contradicted.
  constexpr double k_any_trust = 1e-9;
  if (extraction.strategy == Strategy::automatic) extraction.cell_trust = k_any_trust;
  Extraction result = extract_csg(prepared.cloud, choice.solids, extraction, run);
  if (cost_of(choice.tree, choice, options.solids) < cost_of(result.tree, choice, options.solids)) {
    result.tree = choice.tree;
    ExtractStatistics& statistics = result.statistics;
    statistics.tree = statistics_of(result.tree);
    statistics.cells.reset();
    statistics.warnings.clear();  // they are about the other tree
    const Objective objective = resolve(extraction.objective, prepared.cloud.size(), statistics.noise);
    statistics.fit =
        measure_fit(result.tree, choice.solids, prepared.cloud, objective, statistics.noise, without_stop(run));
  }
  return result;
}

/// find_primitives() within the time limit of the extraction: the choice of solids has a tree to give at any time.
FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  const TimeLimit limit(run.stop, options.extraction.time_limit_seconds);
  RunContext limited = run;
  limited.stop = limit.token();
  try {
    return find_primitives(cloud, options, limited);
  } catch (const Cancelled&) {
    if (run.stop.stop_requested()) throw;
    throw Error({.file = {},
                 .where = "--time-limit",
                 .expected = "the time was over before primitives were found",
                 .remedy = "allow more, or give a --point-budget below the number of points"});
  }
}

void check_surface(const CsgTree& tree, const FoundPrimitives& found, const RunContext& run,
                   std::vector<std::string>& warnings) {
  const double near = std::max(k_bare_spacings * found.prepared.scale.spacing, 2 * found.detection.distance_tolerance);
  const auto bare = find_bare_surface(tree, found.choice.solids, found.prepared.cloud, near, run);
  if (!bare || bare->share < k_much_bare_surface) return;
  warnings.push_back(
      fmt::format("{:.0f} % of the result's surface has no points near it, least of all at ({:.4g}, "
                  "{:.4g}, {:.4g}): what is there is a guess",
                  100 * bare->share, bare->middle.x(), bare->middle.y(), bare->middle.z()));
}

void append(Points& points, const Points& more) {
  points.x.insert(points.x.end(), more.x.begin(), more.x.end());
  points.y.insert(points.y.end(), more.y.begin(), more.y.end());
  points.z.insert(points.z.end(), more.z.begin(), more.z.end());
}

/// Adds the side, if one is missing, to the cloud and to the surfaces.
void close_unseen_side(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  const std::optional<UnseenSide> side = find_unseen_side(cloud, found.detection.surfaces, found.prepared.scale, run);
  if (!side) return;
  DetectedSurface plane{.surface = {.position = side->points.positions[0], .axis = side->normal}, .points = {}};
  plane.points.resize(side->points.size());
  std::iota(plane.points.begin(), plane.points.end(), static_cast<std::uint32_t>(cloud.size()));
  found.added_points = side->points.size();
  append(cloud.positions, side->points.positions);
  append(cloud.normals, side->points.normals);
  append(cloud.sensor_positions, side->points.sensor_positions);
  found.detection.surfaces.push_back(std::move(plane));
  found.warnings.push_back(fmt::format(
      "the side that faces ({:.3g}, {:.3g}, {:.3g}), {:.0f} % of the surface, has no points: it is closed by a plane",
      side->normal.x(), side->normal.y(), side->normal.z(), 100 * side->share));
}

}  // namespace

FoundPrimitives find_primitives(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options.solids);
  Stopwatch watch;
  FoundPrimitives found;
  found.prepared = prepare_cloud(cloud, options.preparation, run);
  found.prepare_seconds = watch.lap();
  found.warnings = found.prepared.warnings;

  found.detection = detect_surfaces(found.prepared.cloud, found.prepared.scale, options.detection, run);
  check_detection(found.detection, found.prepared.cloud, found.warnings);
  if (options.close_unseen_side) close_unseen_side(found, run);
  found.detect_seconds = watch.lap();

  run.report("solids", 0, 1);
  found.choice = choose_solids(found.prepared.cloud, found.detection.surfaces, options.solids, run);
  run.report("solids", 1, 1);
  found.choose_seconds = watch.lap();
  if (found.choice.solids.empty()) {
    throw Error({.file = {},
                 .where = {},
                 .expected = "the surfaces that were found bound no solid",
                 .remedy = "give a cloud of a closed object, or of most of its surface"});
  }
  return found;
}

Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options.extraction);
  const Stopwatch watch;
  FoundPrimitives found = find_in_time(cloud, options, run);
  ReconstructOptions rest = options;
  std::optional<double>& limit = rest.extraction.time_limit_seconds;
  if (limit) limit = std::max(0.0, *limit - watch.seconds());
  Extraction extraction = extract_over(found.choice, found.prepared, rest, run);
  ExtractStatistics& statistics = extraction.statistics;
  statistics.finding = statistics_of(found, cloud.size());
  statistics.finding->disagreement = disagreement(extraction.tree, found.choice.solids, found.choice.places);
  if (statistics.finding->disagreement > k_much_disagreement) {
    found.warnings.push_back(
        fmt::format("the tree is doubtful: it is wrong at places that weigh {:.0f} % of the "
                    "solid's volume and surface",
                    100 * statistics.finding->disagreement));
  }
  check_surface(extraction.tree, found, without_stop(run), found.warnings);
  statistics.warnings.insert(statistics.warnings.begin(), found.warnings.begin(), found.warnings.end());
  statistics.seconds.clean = found.prepare_seconds;
  statistics.seconds.detect = found.detect_seconds;
  statistics.seconds.solids = found.choose_seconds;
  return {.cloud = std::move(found.prepared.cloud),
          .solids = std::move(found.choice.solids),
          .tree = std::move(extraction.tree),
          .statistics = std::move(statistics),
          .snaps = std::move(found.choice.snaps)};
}

}  // namespace cloud2csg
