#pragma once

#include <cstddef>
#include <cstdint>

/// Colours that tell primitives apart.
namespace cloud2csg {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Of points that lie on no primitive.
inline constexpr Colour k_no_primitive_colour{.red = 150, .green = 150, .blue = 150};

/// Of the primitive with this index, always the same: that of the report in its light theme. Neighbours in the list get
/// hues far apart.
[[nodiscard]] Colour primitive_colour(std::size_t index);

}  // namespace cloud2csg
