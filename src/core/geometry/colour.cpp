#include "cloud2csg/advanced/colour.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

// As viewer/src/colours.ts, so that both show a primitive in the same colour.
namespace cloud2csg {
namespace {

std::uint8_t channel(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double value = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * value));
}

/// OKLCH (lightness, chroma, hue in degrees) to sRGB.
Colour from_oklch(double lightness, double chroma, double hue_deg) {
  const double angle = hue_deg * std::numbers::pi / 180;
  const double a = chroma * std::cos(angle);
  const double b = chroma * std::sin(angle);
  const Eigen::Vector3d roots(lightness + 0.3963377774 * a + 0.2158037573 * b,
                              lightness - 0.1055613458 * a - 0.0638541728 * b,
                              lightness - 0.0894841775 * a - 1.291485548 * b);
  const Eigen::Vector3d cones = roots.cwiseProduct(roots).cwiseProduct(roots);
  return {.red = channel(Eigen::Vector3d(4.0767416621, -3.3077115913, 0.2309699292).dot(cones)),
          .green = channel(Eigen::Vector3d(-1.2684380046, 2.6097574011, -0.3413193965).dot(cones)),
          .blue = channel(Eigen::Vector3d(-0.0041960863, -0.7034186147, 1.707614701).dot(cones))};
}

}  // namespace

Colour primitive_colour(std::size_t index) {
  constexpr double k_first_hue = 28;
  constexpr double k_golden_angle = 137.508;
  constexpr std::array k_lighter{0.0, 0.1, -0.07};
  const double hue = std::fmod(k_first_hue + static_cast<double>(index) * k_golden_angle, 360.0);
  return from_oklch(0.62 + k_lighter[index % k_lighter.size()], 0.135, hue);
}

}  // namespace cloud2csg
