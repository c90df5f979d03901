#include "core/geometry/place_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cloud2csg {

std::string place_text(const Eigen::Vector3d& place, double diagonal) {
  constexpr double k_finest = 1e-4;
  constexpr int k_most_decimals = 12;
  const int decimals =
      diagonal > 0 && std::isfinite(diagonal)
          ? std::clamp(static_cast<int>(std::ceil(-std::log10(k_finest * diagonal))), 0, k_most_decimals)
          : k_most_decimals;
  std::array<std::string, 3> texts;
  for (int axis = 0; axis < 3; ++axis) {
    std::string& text = texts[static_cast<std::size_t>(axis)];
    text = fmt::format("{:.{}f}", place[axis], decimals);
    if (text.find('.') != std::string::npos) text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    if (text == "-0") text = "0";
  }
  return fmt::format("({}, {}, {})", texts[0], texts[1], texts[2]);
}

}  // namespace cloud2csg
