#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "core/base/random.hpp"
#include "raw/detect/agreement.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// The surface through a few points with normals (Schnabel, Wahl, Klein 2007, section 4.1), if they determine one. O(1)
[[nodiscard]] std::optional<Surface> plane_through(std::span<const OrientedPoint, 3> points);
[[nodiscard]] std::optional<Surface> sphere_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cylinder_through(std::span<const OrientedPoint, 2> points);
[[nodiscard]] std::optional<Surface> cone_through(std::span<const OrientedPoint, 3> points);

/// Candidates from a neighbourhood: through a few points, then fitted to the agreeing points, which must be at least
/// half. Tries cones only if nothing simpler fits, and tori only if no cone fits.
[[nodiscard]] std::vector<Surface> propose_surfaces(const FreePoints& points, const AgreementLimits& limits,
                                                    RandomStream& random);

/// fit_surface() to points that agree with the start; absent if the result is implausible.
[[nodiscard]] std::optional<Surface> fit_plausible(const Surface& start, std::span<const OrientedPoint> points,
                                                   const AgreementLimits& limits);

/// The same for some of these points of the cloud.
[[nodiscard]] std::optional<Surface> fit_plausible(const Surface& start, const WorkCloud& cloud,
                                                   const std::vector<std::uint32_t>& points,
                                                   const AgreementLimits& limits);

/// estimate_surface(), then fit_plausible().
[[nodiscard]] std::optional<Surface> estimate_plausible(SurfaceType type, std::span<const OrientedPoint> points,
                                                        const AgreementLimits& limits);

}  // namespace cloud2csg
