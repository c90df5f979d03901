#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "core/base/random.hpp"
#include "raw/detect/agreement.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// The surface through so few points with their normals (Schnabel, Wahl, Klein 2007, section 4.1): a plane through 3
/// points, a sphere or a cylinder through 2, a cone through 3. Absent where they determine none. O(1)
[[nodiscard]] std::optional<Surface> plane_through(std::span<const OrientedPoint, 3> points);
[[nodiscard]] std::optional<Surface> sphere_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cylinder_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cone_through(std::span<const OrientedPoint, 3> points);

/// Surfaces that points near each other suggest: through a few of them first, then fitted to those of the neighbourhood
/// that agree, of which there must be half. Cones only where nothing simpler is found, tori where no cone is.
[[nodiscard]] std::vector<Surface> propose_surfaces(const FreePoints& points, const AgreementLimits& limits,
                                                    RandomStream& random);

/// fit_surface() to points that agree with the start; absent also where what comes out is not plausible.
[[nodiscard]] std::optional<Surface> fit_plausible(const Surface& start, std::span<const OrientedPoint> points,
                                                   const AgreementLimits& limits);

/// estimate_surface(), then fit_plausible().
[[nodiscard]] std::optional<Surface> estimate_plausible(SurfaceType type, std::span<const OrientedPoint> points,
                                                        const AgreementLimits& limits);

}  // namespace cloud2csg
