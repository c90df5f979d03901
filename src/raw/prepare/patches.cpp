#include "raw/prepare/patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_links_a_point = 12;
constexpr std::size_t k_least_near = 8;  ///< neighbours that tell the area of a point
constexpr double k_least_cosine = 0.9;
/// Slope of the step beyond what the bend explains: the error of the normals.
constexpr double k_slope = 0.06;
/// Of the noise: errors of places that were moved onto their planes.
constexpr double k_height_noise = 0.5;

}  // namespace

bool on_one_surface(const Vector3d& step, const Vector3d& normal, const Vector3d& other, double noise) {
  const double cosine = std::abs(normal.dot(other));
  if (cosine < k_least_cosine) return false;
  // The chord of an arc and its tangents enclose half of the angle between the tangents.
  const double half_tangent = std::sqrt(std::max(0.0, 1.0 - cosine) / (1.0 + cosine));
  const double rise = std::max(std::abs(step.dot(normal)), std::abs(step.dot(other)));
  return rise <= (k_slope + 1.25 * half_tangent) * step.norm() + k_height_noise * noise;
}

std::vector<double> surface_areas(const Points& places, const Points& normals, const NeighbourTable& neighbours,
                                  double noise) {
  std::vector<double> areas(places.size(), 0.0);
  const std::size_t near = std::max(std::min(k_least_near, neighbours.width), neighbours.width / 2);
  if (near == 0) return areas;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double radius = neighbours.distances_of(i)[near - 1];
    std::size_t count = 0;
    for (const std::uint32_t j : neighbours.of(i).first(near)) {
      const bool is_opposite = std::abs(normals[i].dot(normals[j])) >= k_least_cosine &&
                               !on_one_surface(places[j] - places[i], normals[i], normals[j], noise);
      count += is_opposite ? 0 : 1;
    }
    areas[i] = std::numbers::pi * radius * radius / static_cast<double>(std::max<std::size_t>(count, 1));
  }
  return areas;
}

Patches grow_patches(const Points& places, const Points& normals, const NeighbourTable& neighbours, double noise,
                     std::size_t least, std::size_t most) {
  Patches patches{.of_point = std::vector<std::uint32_t>(places.size(), Patches::k_none),
                  .flipped = std::vector<char>(places.size(), 0),
                  .points = {}};
  std::vector<char> is_done(places.size(), 0);
  const std::size_t links = std::min(k_links_a_point, neighbours.width);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t seed = 0; seed < places.size(); ++seed) {
    if (is_done[seed] != 0) continue;
    is_done[seed] = 1;
    patch.assign(1, seed);
    for (std::size_t next = 0; next < patch.size() && patch.size() < most; ++next) {
      for (const std::uint32_t j : neighbours.of(patch[next]).first(links)) {
        if (patch.size() == most) break;
        if (is_done[j] != 0) continue;
        if (!on_one_surface(places[j] - places[seed], normals[seed], normals[j], noise) ||
            !on_one_surface(places[j] - places[patch[next]], normals[patch[next]], normals[j], noise)) {
          continue;
        }
        is_done[j] = 1;
        patch.push_back(j);
      }
    }
    if (patch.size() < least) {
      // Its points may still belong to a patch that starts elsewhere.
      for (const std::uint32_t i : patch) is_done[i] = i == seed ? 1 : 0;
      continue;
    }
    for (const std::uint32_t i : patch) {
      patches.of_point[i] = static_cast<std::uint32_t>(patches.points.size());
      patches.flipped[i] = normals[i].dot(normals[seed]) < 0.0 ? 1 : 0;
    }
    patches.points.push_back(patch);
  }
  return patches;
}

}  // namespace cloud2csg
