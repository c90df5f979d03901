#pragma once

#include <optional>
#include <span>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Fewer points of a face across a bore may be chance. With half, stray points end bores; double loses narrow floors.
inline constexpr std::ptrdiff_t k_least_floor_points = 10;

/// Where the axis of a cylinder touches the circle through the middle of a torus' tube, within the tolerance, if it
/// does.
[[nodiscard]] std::optional<Eigen::Vector3d> tangent_place(const Surface& cylinder, const Surface& torus,
                                                           double tolerance);

/// Whether a floor ends the bore between its position and a place on its axis: a face with points well within the bore.
/// O(points of the surfaces)
[[nodiscard]] bool is_blind(const Surface& bore, const Eigen::Vector3d& place, const PointCloud& cloud,
                            std::span<const DetectedSurface> surfaces);

}  // namespace cloud2csg
