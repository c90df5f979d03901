#include <algorithm>
#include <functional>
#include <limits>
#include <optional>

#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "core/base/run.hpp"
#include "paper/objective/objective.hpp"
#include "pipeline/extraction_run.hpp"
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
std::optional<Refinement> refinement_of(const Extraction& result, const PointCloud& cloud, const RefineOptions& options,
                                        std::optional<double> seconds, const RunContext& run) {
  const TimeLimit limit(run.stop, seconds);
  limit.enforce();
  try {
    return refine_primitives(cloud, result.model.primitives, result.tree(), options, limit.limited(run));
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

/// Absent when stopped or without time left.
std::optional<Extraction> extracted_again(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          const ExtractOptions& options, const RunContext& run) {
  if (options.time_limit_seconds && *options.time_limit_seconds <= k_next_to_nothing) return std::nullopt;
  try {
    return extract_csg(cloud, primitives, options, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

/// The best by E of `result`, its tree over the refined primitives, and `again`, which another search found over these.
Extraction best_of(Extraction result, const Refinement& refinement, std::optional<Extraction> again,
                   const PointCloud& cloud, const ExtractOptions& options, const RunContext& run) {
  const double noise = again ? again->statistics.noise : refinement.noise;
  const auto fit_of = [&](const CsgTree& some, const PrimitiveSet& over) {
    return measure_fit({.primitives = over, .tree = some}, cloud, noise, options, without_stop(run));
  };
  const FitStatistics given = fit_of(result.tree(), result.model.primitives);
  const FitStatistics moved = fit_of(result.tree(), refinement.primitives);
  const double anew =
      again ? fit_of(again->tree(), refinement.primitives).objective : -std::numeric_limits<double>::infinity();
  if (std::max(moved.objective, anew) <= given.objective) return result;
  RefineStatistics statistics = *result.statistics.refine;
  statistics.is_taken = true;
  if (anew >= moved.objective) {
    result = std::move(*again);
  } else {
    result.model.primitives = refinement.primitives;
    result.statistics.fit = moved;
    result.statistics.verdict = judge_fit(result.model, moved, cloud.positions);
    result.statistics.noise = refinement.noise;
  }
  result.statistics.refine = std::move(statistics);
  return result;
}

using Search = std::function<std::optional<Extraction>(const PrimitiveSet&)>;

Extraction refined_and_searched(Extraction result, const PointCloud& cloud, const ExtractOptions& options,
                                const RefineOptions& refine_options, const RunContext& run, const Search& search) {
  if (!result.statistics.complete || is_constant(result.tree())) return result;
  const Stopwatch watch;
  const std::optional<Refinement> refinement =
      refinement_of(result, cloud, refine_options, options.time_limit_seconds, run);
  const double refine_seconds = watch.seconds();
  if (!refinement) {
    note_incomplete(result.statistics);
    return result;
  }
  result.statistics.refine = statistics_of(*refinement);
  StageSeconds seconds = result.statistics.seconds;
  bool is_complete = true;
  if (refinement->is_better) {
    std::optional<Extraction> again;
    if (search) {
      again = search(refinement->primitives);
      is_complete = again && again->statistics.complete;
    }
    if (again) seconds += again->statistics.seconds;
    result = best_of(std::move(result), *refinement, std::move(again), cloud, options, run);
  }
  seconds.refine = refine_seconds;
  seconds.extraction += refine_seconds;
  seconds.total += refine_seconds;
  result.statistics.seconds = seconds;
  if (!is_complete) note_incomplete(result.statistics);
  return result;
}

/// extract_refined_csg() without a change of frame.
Extraction extract_refined(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                           const RefineOptions& refine_options, const RunContext& run) {
  const Stopwatch watch;
  Extraction result = extract_csg(cloud, primitives, options, run);
  ExtractOptions rest = options;
  rest.time_limit_seconds = seconds_left(options.time_limit_seconds, watch);
  const Search search = [&](const PrimitiveSet& moved) {
    ExtractOptions again = options;
    again.time_limit_seconds = seconds_left(options.time_limit_seconds, watch);
    return extracted_again(cloud, moved, again, run);
  };
  return refined_and_searched(std::move(result), cloud, rest, refine_options, run, search);
}

}  // namespace

Extraction refined(Extraction result, const PointCloud& cloud, const ExtractOptions& options,
                   const RefineOptions& refine_options, const RunContext& run) {
  return refined_and_searched(std::move(result), cloud, options, refine_options, run, {});
}

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
