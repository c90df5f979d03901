#pragma once

#include <cstddef>
#include <cstdint>

namespace cloud2csg {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// Colour of points on no primitive.
inline constexpr Colour k_no_primitive_colour{.red = 150, .green = 150, .blue = 150};

/// The fixed colour of a primitive, as in the report's light theme. Neighbouring indices get distant hues.
[[nodiscard]] Colour primitive_colour(std::size_t index);

}  // namespace cloud2csg
