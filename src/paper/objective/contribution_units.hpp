#pragma once

#include <cstdint>

/// Contributions to E(t) in integer units, whose sums are exact in any order.
namespace cloud2csg {

/// One unit. A contribution is at most 2: 2^23 units.
inline constexpr double k_unit = 1.0 / (1U << 22U);

/// Contributions of a primitive at some points: plain in the lower half, complemented in the upper half.
using PackedContribution = std::uint64_t;

/// Sums over this many points fit the halves.
inline constexpr std::uint32_t k_most_packed_points = 511;

[[nodiscard]] constexpr std::uint64_t plain_units(PackedContribution packed) {
  return packed & 0xffffffffU;
}
[[nodiscard]] constexpr std::uint64_t complement_units(PackedContribution packed) {
  return packed >> 32U;
}

/// Sums over any number of points.
struct WideContribution {
  std::uint64_t plain = 0, complement = 0;  ///< units

  WideContribution& operator+=(const WideContribution& other) {
    plain += other.plain;
    complement += other.complement;
    return *this;
  }
  friend bool operator==(const WideContribution&, const WideContribution&) = default;
};

[[nodiscard]] constexpr WideContribution widened(PackedContribution packed) {
  return {plain_units(packed), complement_units(packed)};
}

}  // namespace cloud2csg
