#include <algorithm>
#include <limits>
#include <optional>

#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "core/base/run.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/time_limit.hpp"
#include "pipeline/verdict.hpp"

namespace cloud2csg {
namespace {

RefineStatistics statistics_of(const Refinement& refinement) {
  return {.is_taken = false,
          .rounds = refinement.rounds,
          .points = refinement.points,
          .rms_before = refinement.rms_before,
          .rms_after = refinement.rms_after,
          .changes = refinement.changes,
          .regularities = refinement.regularities};
}

void note_incomplete(ExtractStatistics& statistics) {
  if (statistics.complete) statistics.warnings.emplace_back("stopped early: this is the best tree so far");
  statistics.complete = false;
}

/// Absent when stopped or past the time limit.
std::optional<Refinement> refined(const PointCloud& cloud, const PrimitiveSet& primitives, const CsgTree& tree,
                                  const RefineOptions& options, std::optional<double> seconds, const RunContext& run) {
  const TimeLimit limit(run.stop, seconds);
  RunContext limited = run;
  limited.stop = limit.token();
  limit.enforce();
  try {
    return refine_primitives(cloud, primitives, tree, options, limited);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

/// Absent when stopped or without time left.
std::optional<Extraction> extracted_again(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          ExtractOptions options, std::optional<double> seconds,
                                          const RunContext& run) {
  if (seconds && *seconds <= 0) return std::nullopt;
  options.time_limit_seconds = seconds;
  try {
    return extract_csg(cloud, primitives, options, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

/// extract_refined_csg() without a change of frame.
Extraction extract_refined(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                           const RefineOptions& refine_options, const RunContext& run) {
  const Stopwatch watch;
  const auto seconds_left = [&]() -> std::optional<double> {
    if (!options.time_limit_seconds) return std::nullopt;
    return std::max(0.0, *options.time_limit_seconds - watch.seconds());
  };
  Extraction result = extract_csg(cloud, primitives, options, run);
  const CsgTree tree = result.tree();
  if (!result.statistics.complete || is_constant(tree)) return result;

  Stopwatch refining;
  const std::optional<Refinement> refinement = refined(cloud, primitives, tree, refine_options, seconds_left(), run);
  const double refine_seconds = refining.lap();
  if (!refinement) {
    note_incomplete(result.statistics);
    return result;
  }
  StageSeconds seconds = result.statistics.seconds;
  RefineStatistics statistics = statistics_of(*refinement);
  std::optional<Extraction> again;
  if (refinement->is_better) again = extracted_again(cloud, refinement->primitives, options, seconds_left(), run);
  if (again) seconds += again->statistics.seconds;
  const bool is_complete = !refinement->is_better || (again && again->statistics.complete);

  if (refinement->is_better) {
    const double noise = again ? again->statistics.noise : refinement->noise;
    const auto fit_of = [&](const CsgTree& some, const PrimitiveSet& over) {
      return measure_fit({.primitives = over, .tree = some}, cloud, noise, options, without_stop(run));
    };
    const FitStatistics given = fit_of(tree, primitives);
    const FitStatistics moved = fit_of(tree, refinement->primitives);
    const double anew =
        again ? fit_of(again->tree(), refinement->primitives).objective : -std::numeric_limits<double>::infinity();
    if (std::max(moved.objective, anew) > given.objective) {
      statistics.is_taken = true;
      if (anew >= moved.objective) {
        result = std::move(*again);
      } else {
        result.model.primitives = refinement->primitives;
        result.statistics.fit = moved;
        result.statistics.verdict = judge_fit(result.model, moved, cloud.positions);
        result.statistics.noise = refinement->noise;
      }
    }
  }
  seconds.refine = refine_seconds;
  seconds.extraction += refine_seconds;
  seconds.total += refine_seconds;
  result.statistics.seconds = seconds;
  if (!is_complete) note_incomplete(result.statistics);
  result.statistics.refine = std::move(statistics);
  return result;
}

}  // namespace

Extraction extract_refined_csg(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                               const RefineOptions& refine_options, const RunContext& run) {
  validate(refine_options);
  const Eigen::Vector3d origin = frame_origin(cloud.positions);
  if (origin.isZero(0)) return extract_refined(cloud, primitives, options, refine_options, run);
  Extraction result =
      extract_refined(seen_from(cloud, origin), seen_from(primitives, origin), options, refine_options, run);
  const bool have_moved = result.statistics.refine && result.statistics.refine->is_taken;
  return moved_back(std::move(result), origin, have_moved ? PrimitiveSet{} : primitives);
}

}  // namespace cloud2csg
