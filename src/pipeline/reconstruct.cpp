#include "cloud2csg/reconstruct.hpp"

#include <optional>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/run.hpp"
#include "core/base/warnings.hpp"
#include "core/geometry/subset.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/diagnostics.hpp"
#include "pipeline/extraction_run.hpp"
#include "pipeline/find_primitives.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/time_limit.hpp"
#include "pipeline/verdict.hpp"
#include "raw/solids/overshoot.hpp"

namespace cloud2csg {
namespace {

/// The chosen solids with the tree that they were chosen with, not yet measured against the cloud.
Extraction with_tree_of_choice(const FoundPrimitives& found, const ExtractOptions& options, const RunContext& run) {
  Extraction result{.model = {.primitives = found.choice.solids, .tree = found.choice.tree}};
  ExtractStatistics& statistics = result.statistics;
  statistics.strategy = options.strategy;
  statistics.parallel = options.parallel;
  statistics.threads = run.threads > 0 ? run.threads : usable_threads(run);
  statistics.seed = options.seed;
  statistics.points = found.prepared.cloud.size();
  statistics.unassigned_points = statistics.points - count_of(found.points);
  statistics.primitives = found.choice.solids.size();
  statistics.noise = found.prepared.scale.noise;
  if (found.no_solid) return result;
  statistics.tree = statistics_of(found.choice.tree, found.choice.solids);
  statistics.before_simplification = statistics.tree;
  statistics.steps = {{"choice of solids", found.choice.tree.size()}};
  return result;
}

/// The tree of the choice, measured against the cloud, or that of a strategy that was asked for.
Extraction extract_over(const FoundPrimitives& found, const ExtractOptions& options, const RunContext& run) {
  if (options.strategy != Strategy::automatic) {
    PointCloud closed = found.prepared.cloud;
    append(closed, found.added);
    return extract_csg(closed, found.choice.solids, options, run);
  }
  Extraction result = with_tree_of_choice(found, options, run);
  const RunContext whole = without_stop(run);
  ExtractStatistics& statistics = result.statistics;
  const Stopwatch watch;
  statistics.noise = measure_noise_scale(found.prepared.cloud, found.choice.solids, options.segmentation, whole).noise;
  statistics.fit = measure_fit(result.model, found.prepared.cloud, statistics.noise, options, whole);
  statistics.seconds.segment = statistics.seconds.extraction = watch.seconds();
  return result;
}

/// Separates the surfaces of the solids in the tree, as far as the time allows. This comes last: a search for other
/// trees would need evidence for cells between them. Counts as choice of solids.
void let_overshoot(Extraction& result, const ReconstructOptions& options, std::optional<double> limit_seconds,
                   const RunContext& run) {
  const Stopwatch watch;
  const TimeLimit limit(run.stop, limit_seconds);
  result.model.primitives = with_overshoots(std::move(result.model.primitives), result.tree(), options.known.size(),
                                            bounds_of(result.cloud.positions), limit.limited(run));
  result.statistics.seconds.solids += watch.seconds();
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
  const Stopwatch watch;
  FoundPrimitives found = find_in_time(cloud, options, run);
  append(found.warnings, unused_known_warnings(found.choice.tree, found, options.known, found.warnings));
  Extraction result = with_tree_of_choice(found, options.extraction, run);
  result.statistics.finding = statistics_of(found, options.known.size(), cloud.size());
  result.statistics.finding->disagreement = found.choice.disagreement;
  result.statistics.verdict = judge_detection(found);
  if (found.no_solid) found.warnings.emplace_back(found.no_solid->what());
  take_finding(result, found);
  note_seconds(found, result.statistics.seconds);
  if (!found.no_solid) {
    let_overshoot(result, options, seconds_left(options.extraction.time_limit_seconds, watch), run);
  }
  result.statistics.warnings = std::move(found.warnings);
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
  ReconstructOptions rest = options;
  std::optional<double>& limit = rest.extraction.time_limit_seconds;
  std::optional<double>& tolerance = rest.extraction.segmentation.distance_tolerance;
  if (!tolerance) tolerance = detection_tolerance(options.detection, found.prepared.scale);
  const bool is_over = limit && *limit <= watch.seconds();
  limit = seconds_left(limit, watch);
  const Stopwatch extracting;
  Extraction result = with_warnings(found.warnings, [&] {
    if (found.no_solid) throw Error(*found.no_solid);
    return extract_over(found, rest.extraction, run);
  });
  ExtractStatistics& statistics = result.statistics;
  if (is_over) statistics.complete = false;
  if (options.refine) {
    limit = seconds_left(limit, extracting);
    result = refined(std::move(result), found.prepared.cloud, rest.extraction, *options.refine, run);
  }
  statistics.finding = statistics_of(found, options.known.size(), cloud.size());
  append(found.warnings, statistics.warnings);
  append(found.warnings, unused_known_warnings(result.tree(), found, options.known, found.warnings));
  statistics.warnings = std::move(found.warnings);
  take_finding(result, found);
  note_seconds(found, statistics.seconds);
  let_overshoot(result, rest, seconds_left(options.extraction.time_limit_seconds, watch), run);
  result = judged(std::move(result), found.added.positions, found.choice.places, found.origin, without_stop(run));
  return moved_back(std::move(result), found.origin, options.known);
}

}  // namespace cloud2csg
