#include <algorithm>
#include <cmath>

#include "bench/families/family_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_panel_cell = 1.2;  ///< distance between centres of features
constexpr double k_margin = 0.5;      ///< around the outermost cells
constexpr double k_top = 0.25;        ///< half of the panel's thickness

}  // namespace

void build_panel(FamilyBuilder& builder, const FamilyOptions& options) {
  RandomStream random = family_stream(Family::panel, options, 0);
  const std::size_t features = options.primitives - 1;
  const std::size_t places = std::max<std::size_t>(features, 1);
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(places))));
  const std::size_t rows = (places + columns - 1) / columns;
  const auto middle_of = [](std::size_t step, std::size_t count) {
    return k_panel_cell * (static_cast<double>(step) - 0.5 * static_cast<double>(count - 1));
  };
  const auto length_of = [](std::size_t count) { return k_panel_cell * static_cast<double>(count) + 2 * k_margin; };
  std::vector<CsgTree> solids{
      builder.add(Box{.size = {length_of(columns), length_of(rows), 2 * k_top}}, {.position = Vector3d::Zero()})};
  std::vector<CsgTree> cuts;
  for (std::size_t k = 0; k < features; ++k) {
    const Vector3d middle =
        Vector3d(middle_of(k % columns, columns), middle_of(k / columns, rows), 0) + random_shift(0.06, random);
    const double radius = random.uniform(0.25, 0.45);
    const auto upright = [&](double low, double high) {
      const Pose pose{.position = middle + Vector3d(0, 0, 0.5 * (low + high)), .orientation = random_tilt(1, random)};
      return builder.add(Cylinder{.radius = radius, .height = high - low}, pose);
    };
    switch (random.below(3)) {
      case 0: {
        const double below = random.uniform(0.1, 0.2);
        cuts.push_back(upright(-k_top - below, k_top + random.uniform(0.1, 0.2)));
        break;
      }
      case 1:
        solids.push_back(upright(-0.4 * k_top, k_top + random.uniform(0.4, 0.8)));
        break;
      default:
        cuts.push_back(
            builder.add(Sphere{.radius = radius}, {.position = middle + Vector3d(0, 0, k_top + 0.3 * radius)}));
        break;
    }
  }
  const CsgTree body = unite_all(solids);
  builder.add_part(cuts.empty() ? body : subtract(body, unite_all(cuts)));
}

}  // namespace cloud2csg
