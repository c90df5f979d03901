#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "raw/solids/term_space.hpp"

namespace cloud2csg {

struct EdgeRules {
  AlignedBox bounds = {};        ///< limits beyond the part
  double plane_tolerance = 0;    ///< closer planes are one edge
  double derived_tolerance = 0;  ///< edges where points end merge with edges closer than this
};

/// Adds values that are at least `tolerance` from all present ones. O(edges x values)
void add_distinct(std::vector<double>& edges, const std::vector<double>& values, double tolerance);

/// Edges along the axis of a cylinder or cone, relative to its position: planes across it, and ends of its points. A
/// cone's edges begin at its apex or beyond.
[[nodiscard]] Bins edges_along_axis(const DetectedSurface& surface, const Points& positions,
                                    std::span<const DetectedSurface> surfaces, const EdgeRules& rules);

/// The points on surfaces, or all points if none is: strays do not tell where the part ends. O(points)
[[nodiscard]] Points points_on(std::span<const DetectedSurface> surfaces, const Points& positions);

/// Where bent pipes may become straight, no surface shows: planes without points through the axes of tori, across the
/// directions of planes and cylinders. O(surfaces^2)
[[nodiscard]] std::vector<DetectedSurface> bend_planes(std::span<const DetectedSurface> surfaces);

/// The direction or its opposite: the one that turns a solid less from the z axis.
[[nodiscard]] Eigen::Vector3d upright(const Eigen::Vector3d& direction);

/// Whether directions are equal up to sign, rounding and residual irregularity.
[[nodiscard]] bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace cloud2csg
