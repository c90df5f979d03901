#pragma once

#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/run_context.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// By point: the noise there in units of the noise that the limits allow for, 1 where it is not clearly more; empty if
/// it is twice that almost nowhere. Patches of points around the planes among the surfaces tell: detail, which would
/// look like noise, has surfaces of its own there. Most of the patches around a point must be noisy, so a noisy region
/// has at least some hundred points. Of more than four times the limits' noise, it sees a part. O(n log n)
/// @throws Cancelled
[[nodiscard]] std::vector<double> local_noise(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                              const AgreementLimits& limits, const RunContext& run);

/// Divides the precision of points by their local noise, and estimates the normals of these points anew: too few
/// neighbours told them. O(n log n) @throws Cancelled
void account_for_noise(WorkCloud& cloud, const std::vector<double>& local_noise, Scale scale, const RunContext& run);

}  // namespace cloud2csg
