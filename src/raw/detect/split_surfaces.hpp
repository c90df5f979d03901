#pragma once

#include <vector>

#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Splits surfaces whose points show a step. The more points, the lower a step may be: with hundreds, two standard
/// deviations of the noise; with thousands on either side, one. Both parts have the type of the surface. It is shown if
/// - the points are a million times as likely with two surfaces as with one. Two surfaces are fitted to one half of the
///   points; the likelihoods are those of the other half (split likelihood ratio test: Wasserman, Ramdas and
///   Balakrishnan 2020). The one surface may have a smooth form error, a quadratic function of the place;
/// - away from the step, the smaller of the two explains its points as well as the average of each point's neighbours
///   does, give or take a standard error; and the two are apart where their points meet. So no rounded edge or other
///   gradual form error is a step.
///
/// The errors of points must be independent: where neighbours share theirs, the two halves do not test each other.
/// Free points near a surface may be points of its parts. The parts have disjoint points. O(cloud + points log points)
/// for each surface. @throws Cancelled
[[nodiscard]] std::vector<GrownSurface> split_surfaces(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                                       const SearchLimits& limits, const RunContext& run);

}  // namespace cloud2csg
