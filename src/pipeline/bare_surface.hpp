#pragma once

#include <optional>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// The surface of a solid that no point of a cloud is near.
struct BareSurface {
  double share = 0;                                  ///< of the solid's surface within the bounds of the cloud
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< the place on it that is farthest from all points
};

/// Estimated by samples, always the same. Absent where no sample is on the surface. O(points log points + samples x
/// size)
[[nodiscard]] std::optional<BareSurface> find_bare_surface(const CsgTree& tree, const PrimitiveSet& primitives,
                                                           const PointCloud& cloud, double near,
                                                           const RunContext& run = {});

}  // namespace cloud2csg
