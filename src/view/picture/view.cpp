#include "view/picture/view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cloud2csg {

using Eigen::Vector3d;

View view_of(const AlignedBox& box, double azimuth_deg, double elevation_deg, std::size_t columns, std::size_t rows) {
  const double azimuth = azimuth_deg * std::numbers::pi / 180;
  const double elevation = elevation_deg * std::numbers::pi / 180;
  View view{};
  view.columns = columns;
  view.rows = rows;
  const Vector3d level(std::cos(azimuth), std::sin(azimuth), 0);
  view.forward = -(std::cos(elevation) * level + std::sin(elevation) * Vector3d::UnitZ());
  view.right = Vector3d(-level.y(), level.x(), 0);
  view.up = view.right.cross(view.forward);
  const double wide = view.right.cwiseAbs().dot(box.sizes());
  const double high = view.up.cwiseAbs().dot(box.sizes());
  const double deep = view.forward.cwiseAbs().dot(box.sizes());
  constexpr double k_margin = 1.08;
  const auto across = static_cast<double>(columns);
  const auto down = static_cast<double>(rows);
  view.step = k_margin * std::max(wide / across, high / down);
  if (!(view.step > 0)) view.step = 1;  // a single point
  view.corner = box.center() - 0.5 * view.step * ((across - 1) * view.right - (down - 1) * view.up) -
                (0.5 * deep + 0.01 * (wide + high + deep)) * view.forward;
  return view;
}

}  // namespace cloud2csg
