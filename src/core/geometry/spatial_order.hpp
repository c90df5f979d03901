#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// A cube of 2^bits cells along each axis, numbered along Morton's space-filling curve. An octree cell is a run of
/// numbers: cells within one that is 2^k wide differ only in their lowest 3 k bits.
class MortonCurve {
 public:
  /// Most bits along each axis, so that the numbers fit 32 bits.
  static constexpr int k_most_bits = 10;

  /// Precondition: 1 <= bits <= k_most_bits.
  MortonCurve(Eigen::Vector3d corner, double edge, int bits);

  [[nodiscard]] int bits() const { return bits_; }
  /// Points outside of the cube belong to the cells at its border.
  [[nodiscard]] std::uint32_t cell_of(double x, double y, double z) const {
    return step(x - corner_.x()) | step(y - corner_.y()) << 1U | step(z - corner_.z()) << 2U;
  }

 private:
  /// The cell along one axis, its bits spread three apart.
  [[nodiscard]] std::uint32_t step(double offset) const {
    // Take the lower bound first: it turns NaN into 0, so the result is always an index.
    const double cell = std::min(std::max(0.0, offset * cells_a_unit_), last_step_);
    return spread_[static_cast<std::size_t>(static_cast<std::int32_t>(cell))];
  }

  Eigen::Vector3d corner_;
  int bits_;
  double last_step_, cells_a_unit_;
  std::array<std::uint32_t, 1U << k_most_bits> spread_{};
};

/// The indices of all points along the curve, stable within a cell. O(n). Does not depend on the number of threads.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(PointsView positions, const MortonCurve& curve,
                                                       const RunContext& run = {});

/// The order along a curve through `box`, which holds the points, with as many cells as suit points on a surface.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(PointsView positions, const AlignedBox& box,
                                                       const RunContext& run = {});

}  // namespace cloud2csg
