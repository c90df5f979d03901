#pragma once

#include "cloud2csg/advanced/prepare.hpp"
#include "raw/prepare/local_fit.hpp"

namespace cloud2csg {

/// The normals of planes that were fitted already, turned outward: the second half of estimate_normals().
/// @throws Cancelled
[[nodiscard]] EstimatedNormals orient_fits(const PointCloud& cloud, const LocalFits& fits, const Scale& scale,
                                           const RunContext& run, const StageShare& share);

}  // namespace cloud2csg
