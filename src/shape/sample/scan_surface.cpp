#include "shape/sample/scan_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

struct Solid {
  const CsgTree* tree;
  const PrimitiveSet* primitives;
  double reach;

  [[nodiscard]] std::vector<double> values(PointsView points) const {
    return implicit_value(*tree, *primitives, points);
  }
  [[nodiscard]] Points gradients(PointsView points) const { return implicit_gradient(*tree, *primitives, points); }
};

/// Relative to the way from the sensor: a few units in the last place of the coordinates.
constexpr double k_converged = 1e-13;

Vector3d place_at(const Ray& ray, double range) {
  return ray.origin + range * ray.direction;
}

/// Newton steps along the rays from the mesh. Returns which hits are left: those that do not arrive, or arrive where
/// the ray leaves the solid.
std::vector<std::size_t> step_to_surface(const Solid& solid, std::span<const Ray> rays,
                                         std::span<std::optional<RayHit>> hits) {
  constexpr int k_most_steps = 12;
  std::vector<std::size_t> moving, left;
  std::vector<double> ranges(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (!hits[i]) continue;
    moving.push_back(i);
    ranges[i] = hits[i]->range;
  }
  for (int step = 0; step < k_most_steps && !moving.empty(); ++step) {
    Points places;
    for (const std::size_t i : moving) places.push_back(place_at(rays[i], ranges[i]));
    const std::vector<double> values = solid.values(places);
    const Points gradients = solid.gradients(places);
    std::vector<std::size_t> still_moving;
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const std::size_t i = moving[k];
      const double slope = gradients[k].dot(rays[i].direction);
      const double move = -values[k] / slope;
      const double range = ranges[i] + move;
      if (!(slope < 0.0) || !(std::abs(range - hits[i]->range) <= solid.reach)) {
        left.push_back(i);
        continue;
      }
      ranges[i] = range;
      if (std::abs(move) > k_converged * range) {
        still_moving.push_back(i);
      } else {
        hits[i] = RayHit{.range = range, .normal = gradients[k].normalized()};
      }
    }
    moving = std::move(still_moving);
  }
  left.insert(left.end(), moving.begin(), moving.end());
  return left;
}

/// The first place within reach of the hit where the ray enters the solid, by cutting the part of the ray again and
/// again; absent where it does not enter.
std::optional<RayHit> search_surface(const Solid& solid, const Ray& ray, double hit_range) {
  constexpr std::size_t k_parts = 32;
  double low = hit_range - solid.reach;
  double width = 2.0 * solid.reach;
  std::array<double, k_parts + 1> ranges{};
  while (width > k_converged * hit_range) {
    Points places;
    for (std::size_t k = 0; k <= k_parts; ++k) {
      ranges[k] = low + width * static_cast<double>(k) / static_cast<double>(k_parts);
      places.push_back(place_at(ray, ranges[k]));
    }
    const std::vector<double> values = solid.values(places);
    const auto inside = std::find_if(values.begin(), values.end(), [](double value) { return value <= 0.0; });
    if (inside == values.begin() || inside == values.end()) return std::nullopt;
    low = ranges[static_cast<std::size_t>(inside - values.begin()) - 1];
    width /= static_cast<double>(k_parts);
  }
  Points place;
  place.push_back(place_at(ray, low));
  const Vector3d gradient = solid.gradients(place)[0];
  const Vector3d normal = gradient.squaredNorm() > 0.0 ? Vector3d(gradient.normalized()) : Vector3d(-ray.direction);
  return RayHit{.range = low, .normal = normal};
}

}  // namespace

SettleHits settle_on_solid(const Model& model, double reach) {
  const Solid solid{.tree = &tree_of(model), .primitives = &model.primitives, .reach = reach};
  return [solid](std::span<const Ray> rays, std::span<std::optional<RayHit>> hits) {
    for (const std::size_t i : step_to_surface(solid, rays, hits)) {
      hits[i] = search_surface(solid, rays[i], hits[i]->range);
    }
  };
}

}  // namespace cloud2csg
