#pragma once

#include <span>

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "view/picture/view.hpp"

namespace cloud2csg {

/// The points as discs that hide what is behind them, so large that a surface hardly shows gaps; shaded where there are
/// normals, and paler the farther away. Without `colours` all are of one grey. O(points x samples of a disc)
[[nodiscard]] Samples draw_cloud(const PointCloud& cloud, std::span<const Colour> colours, const View& view);

}  // namespace cloud2csg
