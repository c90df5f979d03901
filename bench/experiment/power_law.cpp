#include <cmath>

#include "bench/experiment/scaling.hpp"

namespace cloud2csg {

PowerLaw fit_power_law(std::span<const std::pair<double, double>> size_and_value) {
  std::vector<std::pair<double, double>> logs;
  for (const auto& [size, value] : size_and_value) {
    if (size > 0 && value > 0) logs.emplace_back(std::log(size), std::log(value));
  }
  const auto count = static_cast<double>(logs.size());
  double mean_x = 0;
  double mean_y = 0;
  for (const auto& [x, y] : logs) {
    mean_x += x / count;
    mean_y += y / count;
  }
  double squares = 0;
  double products = 0;
  for (const auto& [x, y] : logs) {
    squares += (x - mean_x) * (x - mean_x);
    products += (x - mean_x) * (y - mean_y);
  }
  // Rounding of the mean leaves a residue for equal sizes.
  constexpr double k_one_size = 1e-12;
  if (logs.size() < 2 || squares < k_one_size) return {};
  PowerLaw law{.count = logs.size(), .exponent = products / squares};
  law.factor = std::exp(mean_y - law.exponent * mean_x);
  if (logs.size() == 2) return law;
  double residuals = 0;
  for (const auto& [x, y] : logs) {
    const double residual = y - mean_y - law.exponent * (x - mean_x);
    residuals += residual * residual;
  }
  law.error = std::sqrt(residuals / (count - 2) / squares);
  return law;
}

}  // namespace cloud2csg
