#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Where the axis of a cylinder touches the circle through the middle of a torus' tube, within the tolerance, if it
/// does.
[[nodiscard]] std::optional<Eigen::Vector3d> tangent_place(const Surface& cylinder, const Surface& torus,
                                                           double tolerance);

/// Whether a floor ends the bore between its position and a place on its axis: a face with points well within the bore.
/// O(points of the surfaces)
[[nodiscard]] bool is_blind(const Surface& bore, const Eigen::Vector3d& place, const PointCloud& cloud,
                            std::span<const DetectedSurface> surfaces);

/// The inside of a bent pipe that few or no sensors saw.
struct HiddenBend {
  DetectedSurface inside;  ///< a concave torus with the cloud's points on it, as exact as the outside
  PointCloud hidden = {};  ///< spread over the rest of it, with normals and sensor positions
};

/// Bends whose outside was seen and into whose inside a bore leads: a concave cylinder along the tangent at an end of
/// the bend, or a concave torus around the same circle, which was seen only in part. The pipe's wall is taken to be as
/// thick all along the bend. None without sensor positions. O(points x bends)
[[nodiscard]] std::vector<HiddenBend> find_hidden_bends(const PointCloud& cloud,
                                                        const std::vector<DetectedSurface>& surfaces,
                                                        const Scale& scale);

}  // namespace cloud2csg
