#pragma once

#include <cmath>

namespace cloud2csg {

inline constexpr double k_huber = 1.345;  ///< in noise: 95 % of the efficiency of least squares without outliers
inline constexpr double k_tukey = 4.685;  ///< likewise

enum class LossType { huber, tukey };

/// A robust loss as the square of a modified residual: cost = sum of value^2. Near zero it equals the squared residual.
struct RobustLoss {
  LossType type = LossType::tukey;
  double reach = k_tukey;  ///< residual from which a point counts as an outlier

  struct Value {
    double value, slope;
  };

  [[nodiscard]] Value operator()(double residual) const {
    const double size = std::abs(residual);
    if (size < 1e-6 * reach) return {residual, 1};
    const double sign = residual < 0 ? -1 : 1;
    if (type == LossType::huber) {
      if (size <= reach) return {residual, 1};
      const double value = std::sqrt(reach * (2 * size - reach));
      return {sign * value, reach / value};
    }
    const double ratio = size / reach;
    const double rest = ratio < 1 ? 1 - ratio * ratio : 0;
    const double value = reach * std::sqrt((1 - rest * rest * rest) / 3);
    return {sign * value, size * rest * rest / value};
  }
};

}  // namespace cloud2csg
