#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

/// The frame in which points have their centroid at the origin and a root mean square distance of 1 from it, so that
/// sums of products keep their digits whatever the points' place and size.
struct UnitFrame {
  Eigen::Vector3d origin;
  double scale;  ///< a length of 1 there, in the points' units; above 0
};

/// Precondition: there are points. Points all in one place get a scale of 1.
[[nodiscard]] UnitFrame unit_frame(std::span<const Eigen::Vector3d> points);

[[nodiscard]] std::vector<Eigen::Vector3d> to_frame(const UnitFrame& frame, std::span<const Eigen::Vector3d> points);
[[nodiscard]] Surface to_frame(const UnitFrame& frame, Surface surface);
[[nodiscard]] Surface from_frame(const UnitFrame& frame, Surface surface);

}  // namespace cloud2csg
