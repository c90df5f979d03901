#include "cloud2csg/reconstruct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/without_stop.hpp"
#include "core/geometry/place_text.hpp"
#include "pipeline/bare_surface.hpp"
#include "pipeline/close_unseen.hpp"
#include "pipeline/detect_rest.hpp"
#include "pipeline/fit.hpp"
#include "pipeline/time_limit.hpp"
#include "pipeline/unused_surfaces.hpp"

namespace cloud2csg {
namespace {

constexpr double k_much_unexplained = 0.1;
constexpr double k_coarse = 0.05;  ///< tolerance, of the diagonal
constexpr double k_much_disagreement = 0.1;
constexpr double k_much_bare_surface = 0.05;
constexpr std::size_t k_noted_surface = 200;  ///< points of the cloud for one of a surface that is worth a word
constexpr double k_bare_spacings = 6;         ///< as far from all points, a surface is bare

double share(std::size_t part, std::size_t all) {
  return static_cast<double>(part) / static_cast<double>(all);
}

void check_known(const PrimitiveSet& known) {
  std::set<std::string> ids;
  for (const Primitive& primitive : known) {
    const std::string where = fmt::format("known primitive '{}'", primitive.id);
    if (!ids.insert(primitive.id).second) {
      throw Error({.file = {}, .where = where, .expected = "another has the same id", .remedy = {}});
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

std::size_t count_of(const std::vector<SurfacePoints>& primitives) {
  std::size_t count = 0;
  for (const SurfacePoints& own : primitives) count += own.points.size();
  return count;
}

/// Where most of the points lie that are on no surface, and on nothing that is known.
Eigen::Vector3d unexplained_place(const RestDetection& found, const PreparedCloud& prepared) {
  std::vector<bool> is_explained(prepared.cloud.size(), false);
  const auto note = [&is_explained](std::span<const std::uint32_t> points) {
    for (const std::uint32_t i : points) is_explained[i] = true;
  };
  for (const DetectedSurface& surface : found.detection.surfaces) note(surface.points);
  for (const SurfacePoints& known : found.known) note(known.points);
  Points rest;
  for (std::size_t i = 0; i < is_explained.size(); ++i) {
    if (!is_explained[i]) rest.push_back(prepared.cloud.positions[i]);
  }
  constexpr double k_neighbourhood = 0.1;  // of the diagonal
  return crowded_place(rest, k_neighbourhood * prepared.scale.diagonal);
}

void check_tolerance(double tolerance, double diagonal, std::vector<std::string>& warnings) {
  if (tolerance >= diagonal) {
    throw Error(
        {.file = {},
         .where = "tolerance",
         .expected = fmt::format("{:.3g} is as large as the cloud, whose diagonal is {:.3g}", tolerance, diagonal),
         .remedy = "give it in the cloud's units, or leave it out: it is taken from the noise"});
  }
  if (tolerance <= k_coarse * diagonal) return;
  warnings.push_back(fmt::format("the tolerance, {:.3g}, is {:.2g} % of the cloud's diagonal: smaller parts are lost",
                                 tolerance, 100 * tolerance / diagonal));
}

void check_detection(const RestDetection& found, const PreparedCloud& prepared, std::vector<std::string>& warnings) {
  const PointCloud& cloud = prepared.cloud;
  const Detection& detection = found.detection;
  if (detection.surfaces.empty() && count_of(found.known) == 0) {
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
        fmt::format("{:.0f} % of the points lie on no surface that was found, most of them near {}: a larger "
                    "tolerance than {:.3g} may help, or these parts are of free form",
                    100 * unexplained, place_text(unexplained_place(found, prepared), prepared.scale.diagonal),
                    detection.distance_tolerance));
  }
}

FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t known, std::size_t raw_points) {
  const Scale& scale = found.prepared.scale;
  const std::vector<SurfacePoints> of_known(found.points.begin(),
                                            found.points.begin() + static_cast<std::ptrdiff_t>(known));
  FindingStatistics statistics{.raw_points = raw_points,
                               .added_points = found.added_points,
                               .normals_estimated = found.prepared.normals_estimated,
                               .diagonal = scale.diagonal,
                               .spacing = scale.spacing,
                               .noise = scale.noise,
                               .tolerance = found.detection.distance_tolerance,
                               .known = known,
                               .known_points = count_of(of_known),
                               .unexplained_points = found.detection.unexplained,
                               .snaps = found.choice.snaps};
  for (const DetectedSurface& s : found.detection.surfaces) statistics.surfaces.push_back(s.surface.type);
  return statistics;
}

/// What a tree costs: wrong places, and leaves.
double cost_of(const CsgTree& tree, const SolidChoice& choice, const SolidOptions& options) {
  return disagreement(tree, choice.solids, choice.places) + options.leaf_cost * static_cast<double>(leaf_count(tree));
}

/// With the noise that another tree was measured with.
FitStatistics fit_with(double noise, const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                       const ExtractOptions& options, const RunContext& run) {
  const NoiseScale scale{.noise = noise, .tolerances = segmentation_tolerances(options.segmentation, noise)};
  return measure_fit(tree, primitives, cloud, resolve(options.objective, cloud.size(), noise), scale,
                     without_stop(run));
}

/// There is a tree already to fall back on: no need to search partitions where the cells say little, or are
/// contradicted.
ExtractOptions with_cells_alone(ExtractOptions options) {
  options.cell_trust = 0;
  return options;
}

/// The smallest tree over the chosen solids that the points bear out; or that of the choice, when it costs less.
Extraction extract_over(const SolidChoice& choice, const PreparedCloud& prepared, const ReconstructOptions& options,
                        const RunContext& run) {
  const ExtractOptions extraction = with_cells_alone(options.extraction);
  Extraction result = extract_csg(prepared.cloud, choice.solids, extraction, run);
  if (cost_of(choice.tree, choice, options.solids) < cost_of(result.tree, choice, options.solids)) {
    result.tree = choice.tree;
    ExtractStatistics& statistics = result.statistics;
    statistics.tree = statistics_of(result.tree);
    statistics.steps = {{"choice of solids", result.tree.size()}};
    statistics.cells.reset();
    statistics.warnings.clear();  // they are about the other tree
    statistics.fit = fit_with(statistics.noise, result.tree, choice.solids, prepared.cloud, extraction, run);
  }
  return result;
}

double seconds_left(double limit, double gone) {
  constexpr double k_next_to_nothing = 1e-9;
  return std::max(k_next_to_nothing, limit - gone);
}

/// What was found out about the cloud is true of the refined tree as well.
void refine_found(Reconstruction& found, const ReconstructOptions& options, double seconds_gone,
                  const RunContext& run) {
  ExtractStatistics& before = found.statistics;
  if (!options.refine || !before.complete) return;
  ExtractOptions extraction = with_cells_alone(options.extraction);
  if (extraction.time_limit_seconds) {
    extraction.time_limit_seconds = seconds_left(*extraction.time_limit_seconds, seconds_gone);
  }
  RefinedExtraction refined = extract_refined_csg(found.cloud, found.solids, extraction, *options.refine, run);
  ExtractStatistics& after = refined.extraction.statistics;
  before.refine = after.refine;
  before.seconds.refine = after.seconds.refine;
  if (before.refine) before.refine->is_taken = false;
  if (after.fit.objective <= fit_with(after.noise, found.tree, found.solids, found.cloud, extraction, run).objective) {
    return;
  }
  for (const std::string& warning : after.warnings) {
    if (std::ranges::find(before.warnings, warning) == before.warnings.end()) before.warnings.push_back(warning);
  }
  after.warnings = std::move(before.warnings);
  after.finding = before.finding;
  after.seconds.extraction += before.seconds.extraction;
  found.solids = std::move(refined.primitives);
  found.tree = std::move(refined.extraction.tree);
  found.statistics = std::move(after);
}

void check_surface(const CsgTree& tree, const FoundPrimitives& found, const RunContext& run,
                   std::vector<std::string>& warnings) {
  const double near = std::max(k_bare_spacings * found.prepared.scale.spacing, 2 * found.detection.distance_tolerance);
  const auto bare = find_bare_surface(tree, found.choice.solids, found.prepared.cloud, near, run);
  if (!bare || bare->share < k_much_bare_surface) return;
  warnings.push_back(
      fmt::format("{:.0f} % of the result's surface has no points near it, least of all at {}: what is there "
                  "is a guess",
                  100 * bare->share, place_text(bare->middle, found.prepared.scale.diagonal)));
}

/// A part may be too small to be worth a leaf.
void check_surfaces_are_used(const CsgTree& tree, const FoundPrimitives& found, std::vector<std::string>& warnings) {
  const PointCloud& cloud = found.prepared.cloud;
  const UnusedSurfaces unused =
      find_unused_surfaces(tree, found.choice.solids, cloud, found.detection.surfaces,
                           2 * found.detection.distance_tolerance, cloud.size() / k_noted_surface);
  if (unused.count == 0) return;
  const DetectedSurface& largest = found.detection.surfaces[unused.largest];
  const Eigen::Vector3d middle = bounds_of(select_points(cloud, largest.points).positions).center();
  warnings.push_back(
      fmt::format("of the surfaces that were found, {} are not on the result, the largest a {} of {} "
                  "points near {}",
                  unused.count, type_name(largest.surface.type), largest.points.size(),
                  place_text(middle, found.prepared.scale.diagonal)));
}

/// Warns of known primitives that a tree does without, unless they are named already.
void check_known_are_used(const CsgTree& tree, const FoundPrimitives& found, const PrimitiveSet& known,
                          std::vector<std::string>& warnings) {
  const std::vector<PrimitiveIndex> used = primitives_of(tree);
  for (PrimitiveIndex p = 0; p < known.size(); ++p) {
    const std::string name = fmt::format("'{}'", known[p].id);
    const auto names_it = [&name](const std::string& text) { return text.find(name) != std::string::npos; };
    if (std::ranges::find(used, p) != used.end() || std::ranges::any_of(warnings, names_it)) continue;
    warnings.push_back(fmt::format("the points do not bear out the known primitive {}: {} of {} lie on it", name,
                                   found.points[p].points.size(), found.prepared.cloud.size()));
  }
}

/// Tells of each solid which points lie on it.
void add_evidence(FoundPrimitives& found, const DetectOptions& options, const RunContext& run) {
  PrimitiveSet& solids = found.choice.solids;
  found.points = deal_points(found.prepared.cloud, solids, tolerances_of(options, found.prepared.scale), run);
  for (std::size_t k = 0; k < solids.size(); ++k) {
    solids[k].evidence = Evidence{.points = found.points[k].points.size(), .rms = found.points[k].rms};
  }
}

/// find_primitives() without a word on known primitives.
FoundPrimitives find_all(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options.detection);
  validate(options.solids);
  check_known(options.known);
  Stopwatch watch;
  FoundPrimitives found;
  found.prepared = prepare_cloud(cloud, options.preparation, run);
  watch.lap();
  found.warnings = found.prepared.warnings;

  const std::optional<double>& tolerance = options.detection.distance_tolerance;
  if (tolerance) check_tolerance(*tolerance, found.prepared.scale.diagonal, found.warnings);
  RestDetection rest = detect_rest(found.prepared.cloud, found.prepared.scale, options.known, options.detection, run);
  check_detection(rest, found.prepared, found.warnings);
  found.detection = std::move(rest.detection);
  // What is known has ends of its own.
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
    throw Error({.file = {},
                 .where = {},
                 .expected = fmt::format("the surfaces that were found, {} in a cloud of {} points, bound no solid",
                                         found.detection.surfaces.size(), found.prepared.cloud.size()),
                 .remedy = "give a cloud of a closed object, or of most of its surface, of some thousand points"});
  }
  found.warnings.insert(found.warnings.end(), found.choice.warnings.begin(), found.choice.warnings.end());
  // The choice may have been cut short, and has a tree all the same.
  add_evidence(found, options.detection, without_stop(run));
  found.choose_seconds = watch.lap();
  return found;
}

/// find_primitives() within the time limit of the extraction: the choice of solids has a tree to give at any time.
FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  const std::optional<double>& seconds = options.extraction.time_limit_seconds;
  const TimeLimit limit(run.stop, seconds);
  RunContext limited = run;
  limited.stop = limit.token();
  const Stopwatch watch;
  try {
    FoundPrimitives found = find_all(cloud, options, limited);
    if (seconds && *seconds <= watch.seconds()) {
      found.warnings.emplace_back("the time was over while solids were chosen: these are the best so far");
    }
    return found;
  } catch (const Cancelled&) {
    if (run.stop.stop_requested()) throw;
    throw Error({.file = {},
                 .where = "--time-limit",
                 .expected = "the time was over before primitives were found",
                 .remedy = "allow more, or give a --point-budget below the number of points"});
  }
}

}  // namespace

FoundPrimitives find_primitives(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  FoundPrimitives found = find_in_time(cloud, options, run);
  check_known_are_used(found.choice.tree, found, options.known, found.warnings);
  return found;
}

Reconstruction reconstruct(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options.extraction);
  if (options.refine) validate(*options.refine);
  if (options.refine && !options.known.empty()) {
    throw Error({.file = {},
                 .where = "refine",
                 .expected = "primitives that are known would be moved",
                 .remedy = "refine all primitives, or none"});
  }
  const Stopwatch watch;
  FoundPrimitives found = find_in_time(cloud, options, run);
  ReconstructOptions rest = options;
  std::optional<double>& limit = rest.extraction.time_limit_seconds;
  std::optional<double>& tolerance = rest.extraction.segmentation.distance_tolerance;
  if (!tolerance) tolerance = detection_tolerance(options.detection, found.prepared.scale);
  const bool is_over = limit && *limit <= watch.seconds();
  if (limit) limit = seconds_left(*limit, watch.seconds());
  const Stopwatch extracting;
  Extraction extraction = extract_over(found.choice, found.prepared, rest, run);
  ExtractStatistics& statistics = extraction.statistics;
  statistics.finding = statistics_of(found, options.known.size(), cloud.size());
  statistics.finding->is_tree_of_choice = extraction.tree == found.choice.tree;
  statistics.finding->disagreement = disagreement(extraction.tree, found.choice.solids, found.choice.places);
  if (statistics.finding->disagreement > k_much_disagreement) {
    const Eigen::Vector3d worst = worst_place(extraction.tree, found.choice.solids, found.choice.places);
    found.warnings.push_back(
        fmt::format("the tree is doubtful: it is wrong at places that weigh {:.0f} % of the solid's volume and "
                    "surface, worst near {}",
                    100 * statistics.finding->disagreement, place_text(worst, found.prepared.scale.diagonal)));
  }
  check_surface(extraction.tree, found, without_stop(run), found.warnings);
  check_surfaces_are_used(extraction.tree, found, found.warnings);
  statistics.warnings.insert(statistics.warnings.begin(), found.warnings.begin(), found.warnings.end());
  check_known_are_used(extraction.tree, found, options.known, statistics.warnings);
  if (is_over) statistics.complete = false;
  Reconstruction result{.cloud = std::move(found.prepared.cloud),
                        .solids = std::move(found.choice.solids),
                        .tree = std::move(extraction.tree),
                        .statistics = std::move(statistics)};
  refine_found(result, rest, extracting.seconds(), run);
  StageSeconds& seconds = result.statistics.seconds;
  seconds.clean = found.prepared.clean_seconds;
  seconds.normals = found.prepared.normals_seconds;
  seconds.detect = found.detect_seconds;
  seconds.solids = found.choose_seconds;
  return result;
}

}  // namespace cloud2csg
