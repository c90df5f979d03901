#pragma once

#include <algorithm>
#include <cstdint>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg {

/// A cubic grid over a box, its cells numbered along Morton's space-filling curve.
class MortonCurve {
 public:
  /// 2^bits cells along the longest side of the box; at most 10 bits.
  MortonCurve(const AlignedBox& box, int bits)
      : corner_(box.min()),
        last_step_((1 << bits) - 1),
        cells_a_unit_((1 << bits) / std::max(box.sizes().maxCoeff(), 1e-300)) {}

  /// Below 2^(3 bits). Points outside of the box count to the cells at its border.
  [[nodiscard]] std::uint32_t cell_of(double x, double y, double z) const {
    return step(x - corner_.x()) | step(y - corner_.y()) << 1U | step(z - corner_.z()) << 2U;
  }

 private:
  /// The cell along one axis, its bits spread three apart.
  [[nodiscard]] std::uint32_t step(double offset) const {
    // The lower bound first: whatever the number, the result is in range.
    auto value = static_cast<std::uint32_t>(std::min(std::max(0.0, offset * cells_a_unit_), last_step_));
    value = (value | value << 16U) & 0x030000ffU;
    value = (value | value << 8U) & 0x0300f00fU;
    value = (value | value << 4U) & 0x030c30c3U;
    return (value | value << 2U) & 0x09249249U;
  }

  Eigen::Vector3d corner_;
  double last_step_;
  double cells_a_unit_;
};

}  // namespace cloud2csg
