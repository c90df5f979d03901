#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// A frame with centroid 0 and root mean square distance 1, where sums of products keep their digits for any points.
struct UnitFrame {
  Eigen::Vector3d origin;
  double scale;  ///< the frame's unit of length in the points' units; above 0
};

/// Precondition: there are points. Coincident points get a scale of 1.
[[nodiscard]] UnitFrame unit_frame(std::span<const Eigen::Vector3d> points);

[[nodiscard]] std::vector<Eigen::Vector3d> to_frame(const UnitFrame& frame, std::span<const Eigen::Vector3d> points);
[[nodiscard]] Surface to_frame(const UnitFrame& frame, Surface surface);
[[nodiscard]] Surface from_frame(const UnitFrame& frame, Surface surface);

}  // namespace cloud2csg
