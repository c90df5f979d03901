#pragma once

#include "cloud2csg/extract.hpp"
#include "pipeline/find_primitives.hpp"

/// Judges results by their points. docs/command_line.md states the thresholds.
namespace cloud2csg {

/// Connected regions of the cloud in which at least half of the points are among `far`, most points first. Single
/// points that noise put there make no region. O(points log far). `far`: ascending indices
[[nodiscard]] std::vector<UnexplainedRegion> unexplained_regions(const Points& points,
                                                                 const std::vector<std::uint32_t>& far);

/// Judges a model's tree by the fit of these points to it.
[[nodiscard]] Verdict judge_fit(const Model& model, const FitStatistics& fit, const Points& points);

/// The result with a verdict that also counts what detection found, and the finding's disagreement of the final tree
/// with the labels of `places`. `added`: points where nobody saw the part; surface beside them is closed. `origin`: of
/// the frame, for texts. Precondition: the statistics have a finding. @throws Cancelled
[[nodiscard]] Extraction judged(Extraction result, const Points& added, const LabelledPlaces& places,
                                const Eigen::Vector3d& origin, const RunContext& run);

/// Judges the detected surfaces and the points on known primitives.
[[nodiscard]] Verdict judge_detection(const FoundPrimitives& found);

}  // namespace cloud2csg
