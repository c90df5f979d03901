#include "cloud2csg/reconstruct.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/run.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/find_primitives.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/verdict.hpp"
#include "raw/solids/overshoot.hpp"

namespace cloud2csg {
namespace {

/// Cost of a tree: wrong places and the price of leaves.
double cost_of(const CsgTree& tree, const SolidChoice& choice, const SolidOptions& options) {
  return wrong_place_share(tree, choice.solids, choice.places) +
         options.leaf_cost * statistics_of(tree, choice.solids).price;
}

/// The tree of the choice is a fall-back, so partitions need not be searched where cells fail.
ExtractOptions with_cells_alone(ExtractOptions options) {
  options.cell_trust = 0;
  return options;
}

/// The extracted tree over the chosen solids, or the tree of the choice when it costs less.
Extraction extract_over(const SolidChoice& choice, const PreparedCloud& prepared, const ReconstructOptions& options,
                        const RunContext& run) {
  const ExtractOptions extraction = with_cells_alone(options.extraction);
  Extraction result = extract_csg(prepared.cloud, choice.solids, extraction, run);
  if (cost_of(choice.tree, choice, options.solids) < cost_of(result.tree(), choice, options.solids)) {
    result.model.tree = choice.tree;
    ExtractStatistics& statistics = result.statistics;
    statistics.tree = statistics_of(choice.tree, choice.solids);
    statistics.steps = {{"choice of solids", choice.tree.size()}};
    statistics.cells.reset();
    statistics.warnings.clear();  // they describe the other tree
    statistics.fit = measure_fit({.primitives = choice.solids, .tree = choice.tree}, prepared.cloud, statistics.noise,
                                 extraction, without_stop(run));
  }
  return result;
}

double seconds_left(double limit, double gone) {
  constexpr double k_next_to_nothing = 1e-9;
  return std::max(k_next_to_nothing, limit - gone);
}

/// Takes the refined tree if its E is higher; the finding's statistics apply to it as well.
void refine_found(Extraction& found, const ReconstructOptions& options, double seconds_gone, const RunContext& run) {
  ExtractStatistics& before = found.statistics;
  if (!options.refine || !before.complete) return;
  ExtractOptions extraction = with_cells_alone(options.extraction);
  if (extraction.time_limit_seconds) {
    extraction.time_limit_seconds = seconds_left(*extraction.time_limit_seconds, seconds_gone);
  }
  Extraction refined = extract_refined_csg(found.cloud, found.model.primitives, extraction, *options.refine, run);
  ExtractStatistics& after = refined.statistics;
  before.refine = after.refine;
  before.seconds.refine = after.seconds.refine;
  if (before.refine) before.refine->is_taken = false;
  const FitStatistics given = measure_fit(found.model, found.cloud, after.noise, extraction, without_stop(run));
  if (after.fit.objective <= given.objective) return;
  for (const std::string& warning : after.warnings) {
    if (std::ranges::find(before.warnings, warning) == before.warnings.end()) before.warnings.push_back(warning);
  }
  after.warnings = std::move(before.warnings);
  after.finding = before.finding;
  after.seconds.extraction += before.seconds.extraction;
  found.model = std::move(refined.model);
  found.statistics = std::move(after);
}

/// Separates the surfaces of the solids in the tree, as the last step: more cells would need more evidence.
void let_overshoot(Extraction& result, const ReconstructOptions& options, const RunContext& run) {
  result.model.primitives = with_overshoots(std::move(result.model.primitives), result.tree(), options.known.size(),
                                            bounds_of(result.cloud.positions));
  result.statistics.fit =
      measure_fit(result.model, result.cloud, result.statistics.noise, options.extraction, without_stop(run));
}

/// Moves the results of the detection into the result.
void take_finding(Extraction& result, FoundPrimitives& found) {
  result.cloud = std::move(found.prepared.cloud);
  result.surfaces = std::move(found.detection.surfaces);
  result.points = std::move(found.points);
}

void note_seconds(const FoundPrimitives& found, StageSeconds& seconds) {
  seconds.clean = found.prepared.clean_seconds;
  seconds.normals = found.prepared.normals_seconds;
  seconds.detect = found.detect_seconds;
  seconds.solids = found.choose_seconds;
}

}  // namespace

Extraction find_primitives(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options);
  FoundPrimitives found = find_in_time(cloud, options, run);
  append(found.warnings, unused_known_warnings(found.choice.tree, found, options.known, found.warnings));
  Extraction result;
  result.statistics.points = found.prepared.cloud.size();
  result.statistics.primitives = found.choice.solids.size();
  result.statistics.noise = found.prepared.scale.noise;
  if (!found.no_solid) result.statistics.tree = statistics_of(found.choice.tree, found.choice.solids);
  result.statistics.finding = statistics_of(found, options.known.size(), cloud.size());
  result.statistics.finding->is_tree_of_choice = true;
  result.statistics.finding->disagreement = found.choice.disagreement;
  result.statistics.verdict = judge_detection(found);
  if (found.no_solid) found.warnings.emplace_back(found.no_solid->what());
  result.model = {.primitives = std::move(found.choice.solids), .tree = std::move(found.choice.tree)};
  take_finding(result, found);
  if (!found.no_solid) let_overshoot(result, options, run);
  result.statistics.warnings = std::move(found.warnings);
  note_seconds(found, result.statistics.seconds);
  return moved_back(std::move(result), found.origin, options.known);
}

Extraction reconstruct(const PointCloud& cloud, const ReconstructOptions& options, const RunContext& run) {
  validate(options);
  if (options.refine && !options.known.empty()) {
    throw invalid_option("refine", "refinement would change the known primitives",
                         "leave out refine or the known primitives");
  }
  const Stopwatch watch;
  FoundPrimitives found = find_in_time(cloud, options, run);
  if (found.no_solid) throw Error(*found.no_solid);
  ReconstructOptions rest = options;
  std::optional<double>& limit = rest.extraction.time_limit_seconds;
  std::optional<double>& tolerance = rest.extraction.segmentation.distance_tolerance;
  if (!tolerance) tolerance = detection_tolerance(options.detection, found.prepared.scale);
  const bool is_over = limit && *limit <= watch.seconds();
  if (limit) limit = seconds_left(*limit, watch.seconds());
  const Stopwatch extracting;
  Extraction result = extract_over(found.choice, found.prepared, rest, run);
  ExtractStatistics& statistics = result.statistics;
  statistics.finding = statistics_of(found, options.known.size(), cloud.size());
  statistics.finding->is_tree_of_choice = result.tree() == found.choice.tree;
  append(found.warnings, statistics.warnings);
  append(found.warnings, unused_known_warnings(result.tree(), found, options.known, found.warnings));
  statistics.warnings = std::move(found.warnings);
  if (is_over) statistics.complete = false;
  take_finding(result, found);
  refine_found(result, rest, extracting.seconds(), run);
  let_overshoot(result, rest, run);
  note_seconds(found, statistics.seconds);
  result = judged(std::move(result), found.choice.places, found.origin, without_stop(run));
  return moved_back(std::move(result), found.origin, options.known);
}

}  // namespace cloud2csg
