#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "core/base/random.hpp"
#include "raw/detect/agreement.hpp"
#include "raw/detect/free_points.hpp"

namespace cloud2csg {

/// Surfaces that points near each other suggest: through a few of them first, then fitted to those of the neighbourhood
/// that agree, of which there must be half. Cones only where nothing simpler is found, tori where no cone is.
[[nodiscard]] std::vector<Surface> propose_surfaces(const FreePoints& points, const AgreementLimits& limits,
                                                    RandomStream& random);

/// Whether a surface is one that points of a cloud of diagonal one can tell from a simpler one.
[[nodiscard]] bool is_plausible(const Surface& surface, const AgreementLimits& limits);

/// fit_surface() to points that agree with the start; absent also where what comes out is not plausible.
[[nodiscard]] std::optional<Surface> fit_plausible(const Surface& start, std::span<const OrientedPoint> points,
                                                   const AgreementLimits& limits);

/// estimate_surface(), then fit_plausible().
[[nodiscard]] std::optional<Surface> estimate_plausible(SurfaceType type, std::span<const OrientedPoint> points,
                                                        const AgreementLimits& limits);

}  // namespace cloud2csg
