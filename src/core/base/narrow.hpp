#pragma once

#include <cstddef>
#include <cstdint>

namespace cloud2csg {

/// An index or a count that is known to fit, as it is kept.
[[nodiscard]] constexpr std::uint32_t narrow(std::size_t n) {
  return static_cast<std::uint32_t>(n);
}

}  // namespace cloud2csg
