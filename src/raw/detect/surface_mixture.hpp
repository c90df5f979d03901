#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Surfaces that explain positions together, whatever the normals are. The rest are outliers.
struct SurfaceMixture {
  std::vector<Surface> surfaces;
  std::vector<std::size_t> surface_of = {};  ///< by position; surfaces.size() for an outlier

  /// Shares of the positions on each surface, then of the outliers. O(positions)
  [[nodiscard]] std::vector<double> shares() const;
};

/// Negative logarithm of the likelihood of the positions, up to a constant. Each is within normally distributed noise
/// of one of the surfaces, or an outlier, with these shares: a row of surfaces.size() + 1 for each position, or one for
/// all. The noise is that of the mixture's own points, but no less than `noise`. Each parameter costs half the
/// logarithm of the positions that it is fitted to (BIC). O(positions x surfaces)
[[nodiscard]] double cost_of(const SurfaceMixture& mixture, std::span<const Eigen::Vector3d> positions,
                             std::span<const double> shares, double noise);

/// Puts each position on the nearest surface within `reach`, or none. O(positions x surfaces)
[[nodiscard]] std::vector<std::size_t> nearest_surfaces(std::span<const Surface> surfaces,
                                                        std::span<const Eigen::Vector3d> positions, double reach);

/// The plane, two about parallel planes, cylinder or sphere of least cost, each with at least `least_points` positions;
/// absent if none fits. It begins along the principal axes of the positions. The sides of the material are arbitrary.
/// O(positions)
[[nodiscard]] std::optional<SurfaceMixture> fit_mixture(std::span<const Eigen::Vector3d> positions,
                                                        std::size_t least_points, const AgreementLimits& limits);

}  // namespace cloud2csg
