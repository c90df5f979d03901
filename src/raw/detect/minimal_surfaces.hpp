#pragma once

#include <optional>
#include <span>

#include "cloud2csg/advanced/surface.hpp"
#include "raw/detect/oriented_point.hpp"

namespace cloud2csg {

/// The surface through so few points with their normals (Schnabel, Wahl, Klein 2007, section 4.1): a plane through 3
/// points, a sphere or a cylinder through 2, a cone through 3. Absent where they determine none. O(1)
[[nodiscard]] std::optional<Surface> plane_through(std::span<const OrientedPoint, 3> points);
[[nodiscard]] std::optional<Surface> sphere_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cylinder_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cone_through(std::span<const OrientedPoint, 3> points);

}  // namespace cloud2csg
