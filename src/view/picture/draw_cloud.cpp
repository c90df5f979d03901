#include "view/picture/draw_cloud.hpp"

#include <algorithm>
#include <cmath>

#include "view/picture/draw_solid.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// In samples: a little more than half of the spacing that the points would have, were they spread over the surface of
/// their bounds.
double disc_radius(const AlignedBox& box, std::size_t points, double step) {
  const Vector3d s = box.sizes();
  const double area = 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  constexpr double k_least = 1.1;  // a third of a pixel
  constexpr double k_most = 6;
  return std::clamp(0.6 * std::sqrt(area / static_cast<double>(points)) / step, k_least, k_most);
}

/// Draws one disc with its middle at (x, y) samples, where nothing is nearer.
void draw_disc(Samples& samples, const View& view, double x, double y, double radius, const Sample& disc) {
  const auto first = [radius](double middle) { return std::max(0.0, std::ceil(middle - radius)); };
  for (double row = first(y); row <= y + radius && row < static_cast<double>(view.rows); ++row) {
    for (double column = first(x); column <= x + radius && column < static_cast<double>(view.columns); ++column) {
      if (std::hypot(row - y, column - x) > radius) continue;
      Sample& sample = samples[static_cast<std::size_t>(row) * view.columns + static_cast<std::size_t>(column)];
      if (disc.depth < sample.depth) sample = disc;
    }
  }
}

}  // namespace

Samples draw_cloud(const PointCloud& cloud, std::span<const Colour> colours, const View& view) {
  Samples samples(view.columns * view.rows);
  const AlignedBox box = bounds_of(cloud.positions);
  const double radius = disc_radius(box, cloud.size(), view.step);
  const double nearest = (box.center() - view.corner).dot(view.forward) - 0.5 * box.diagonal().norm();
  const double depth_of_box = std::max(box.diagonal().norm(), 1e-300);
  const Vector3f plain = linear_colour({.red = 72, .green = 92, .blue = 128});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d place = cloud.positions[i] - view.corner;
    const double depth = place.dot(view.forward);
    // Points that face away are seen from behind, through gaps or on an open surface: pale, so that both sides of the
    // solid can be told apart.
    const Vector3d normal = cloud.has_normals() ? cloud.normals[i] : Vector3d(-view.forward);
    const bool is_behind = normal.dot(view.forward) > 0;
    const Vector3d facing = is_behind ? Vector3d(-normal) : normal;
    const double far = std::clamp((depth - nearest) / depth_of_box, 0.0, 1.0);
    const auto haze = static_cast<float>(is_behind ? 0.7 : 0.25 * far);
    const Vector3f colour = brightness(facing, view) * (colours.empty() ? plain : linear_colour(colours[i]));
    draw_disc(samples, view, place.dot(view.right) / view.step, -place.dot(view.up) / view.step, radius,
              {.depth = static_cast<float>(depth), .colour = (1 - haze) * colour + Vector3f::Constant(haze)});
  }
  return samples;
}

}  // namespace cloud2csg
