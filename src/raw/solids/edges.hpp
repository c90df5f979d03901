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
  double derived_tolerance = 0;  ///< edges that curved surfaces suggest merge with edges closer than this
};

/// Edges along a direction: planes across it and, if there are any, middles and sides of curved surfaces and ends of
/// bends. At least two, ascending.
[[nodiscard]] Bins edges_along(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces,
                               const EdgeRules& rules);

/// Edges along the axis of a cylinder or cone, relative to its position: planes across it, ends of bends, and ends of
/// its points. A cone's edges begin at its apex or beyond.
[[nodiscard]] Bins edges_along_axis(const DetectedSurface& surface, const Points& positions,
                                    std::span<const DetectedSurface> surfaces, const EdgeRules& rules);

/// Right-handed orthogonal frames (columns) of directions with at least two planes, most points first; never empty.
[[nodiscard]] std::vector<Eigen::Matrix3d> orthogonal_frames(std::span<const DetectedSurface> surfaces);

/// Whether directions are equal up to sign, rounding and residual irregularity.
[[nodiscard]] bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace cloud2csg
