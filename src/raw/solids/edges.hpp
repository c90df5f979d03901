#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "raw/solids/term_space.hpp"

namespace cloud2csg {

/// Where solids may end.
struct EdgeRules {
  AlignedBox bounds = {};        ///< the ends: beyond the part
  double plane_tolerance = 0;    ///< planes nearer than this are one edge
  double derived_tolerance = 0;  ///< what curved surfaces suggest nearer to an edge than this is that edge
};

/// Edges along a direction: planes across it and, where there are any, the middles and sides of curved surfaces, and
/// where bends end. Two at least, ascending.
[[nodiscard]] Bins edges_along(const Eigen::Vector3d& direction, std::span<const DetectedSurface> surfaces,
                               const EdgeRules& rules);

/// Edges along the axis of a cylinder or cone, measured from its position: planes across it, where bends end, and how
/// far its own points reach. Those of a cone begin at its apex or beyond.
[[nodiscard]] Bins edges_along_axis(const DetectedSurface& surface, const Points& positions,
                                    std::span<const DetectedSurface> surfaces, const EdgeRules& rules);

/// Orthogonal frames of directions that have two planes or more across them, those of the most points first; one frame
/// at least. Columns, right-handed.
[[nodiscard]] std::vector<Eigen::Matrix3d> orthogonal_frames(std::span<const DetectedSurface> surfaces);

/// Whether directions are the same, up to sign, but for rounding and what regularities left.
[[nodiscard]] bool are_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

}  // namespace cloud2csg
