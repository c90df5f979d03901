#include <algorithm>
#include <limits>
#include <optional>

#include "base/stopwatch.hpp"
#include "base/without_stop.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "pipeline/fit.hpp"

namespace cloud2csg {
namespace {

void add_seconds(StageSeconds& to, const StageSeconds& seconds) {
  to.segment += seconds.segment;
  to.overlap += seconds.overlap;
  to.partition += seconds.partition;
  to.classes += seconds.classes;
  to.search += seconds.search;
  to.merge += seconds.merge;
  to.simplify += seconds.simplify;
  to.extraction += seconds.extraction;
  to.total += seconds.total;
}

/// E and the rest of a tree over primitives, all measured alike.
class Comparison {
 public:
  Comparison(const PointCloud& cloud, const ExtractOptions& options, double noise, const RunContext& run)
      : cloud_(cloud),
        objective_(resolve(options.objective, cloud.size(), noise)),
        noise_(noise),
        run_(without_stop(run)) {}

  [[nodiscard]] FitStatistics operator()(const CsgTree& tree, const PrimitiveSet& primitives) const {
    return measure_fit(tree, primitives, cloud_, objective_, noise_, run_);
  }

 private:
  const PointCloud& cloud_;
  Objective objective_;
  double noise_;
  RunContext run_;
};

RefineStatistics statistics_of(const Refinement& refinement) {
  return {.is_taken = false,
          .rounds = refinement.rounds,
          .points = refinement.points,
          .rms_before = refinement.rms_before,
          .rms_after = refinement.rms_after,
          .changes = refinement.changes,
          .regularities = refinement.regularities};
}

/// Absent when stopped.
std::optional<Refinement> refined(const PointCloud& cloud, const PrimitiveSet& primitives, const CsgTree& tree,
                                  const RefineOptions& options, const RunContext& run) {
  try {
    return refine_primitives(cloud, primitives, tree, options, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

std::optional<Extraction> extracted_again(const PointCloud& cloud, const PrimitiveSet& primitives,
                                          ExtractOptions options, double seconds_gone, const RunContext& run) {
  if (options.time_limit_seconds) {
    if (*options.time_limit_seconds <= seconds_gone) return std::nullopt;
    *options.time_limit_seconds -= seconds_gone;
  }
  try {
    return extract_csg(cloud, primitives, options, run);
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

}  // namespace

RefinedExtraction extract_refined_csg(const PointCloud& cloud, const PrimitiveSet& primitives,
                                      const ExtractOptions& options, const RefineOptions& refine_options,
                                      const RunContext& run) {
  validate(refine_options);
  const Stopwatch watch;
  RefinedExtraction result{.primitives = primitives, .extraction = extract_csg(cloud, primitives, options, run)};
  Extraction& first = result.extraction;
  if (!first.statistics.complete || is_constant(first.tree)) return result;

  Stopwatch refining;
  const std::optional<Refinement> refinement = refined(cloud, primitives, first.tree, refine_options, run);
  const double refine_seconds = refining.lap();
  if (!refinement) {
    first.statistics.complete = false;
    return result;
  }
  StageSeconds seconds = first.statistics.seconds;
  RefineStatistics statistics = statistics_of(*refinement);
  std::optional<Extraction> again;
  if (refinement->is_better) again = extracted_again(cloud, refinement->primitives, options, watch.seconds(), run);
  if (again) add_seconds(seconds, again->statistics.seconds);

  if (refinement->is_better) {
    const Comparison fit_of(cloud, options, again ? again->statistics.noise : refinement->noise, run);
    const FitStatistics given = fit_of(first.tree, primitives);
    const FitStatistics moved = fit_of(first.tree, refinement->primitives);
    const double anew =
        again ? fit_of(again->tree, refinement->primitives).objective : -std::numeric_limits<double>::infinity();
    if (std::max(moved.objective, anew) > given.objective) {
      statistics.is_taken = true;
      result.primitives = refinement->primitives;
      if (anew >= moved.objective) {
        first = std::move(*again);
      } else {
        first.statistics.fit = moved;
        first.statistics.noise = refinement->noise;
      }
    }
  }
  seconds.refine = refine_seconds;
  seconds.extraction += refine_seconds;
  seconds.total += refine_seconds;
  first.statistics.seconds = seconds;
  first.statistics.refine = std::move(statistics);
  return result;
}

}  // namespace cloud2csg
