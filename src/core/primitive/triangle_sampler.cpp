#include "core/primitive/triangle_sampler.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace cloud2csg {
namespace {

Eigen::Vector3d doubled_area_vector(const Triangle& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

std::vector<Triangle> triangles_of(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners) {
  std::vector<Triangle> triangles;
  triangles.reserve(corners.size());
  for (const auto& [a, b, c] : corners) triangles.push_back({vertices[a], vertices[b], vertices[c]});
  return triangles;
}

}  // namespace

TriangleSampler::TriangleSampler(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  cumulative_area_.reserve(triangles_.size());
  double area = 0.0;
  for (const Triangle& triangle : triangles_) {
    area += 0.5 * doubled_area_vector(triangle).norm();
    cumulative_area_.push_back(area);
  }
}

TriangleSampler::TriangleSampler(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners)
    : TriangleSampler(triangles_of(vertices, corners)) {}

TriangleSampler::Draw TriangleSampler::draw(RandomStream& random) const {
  const double target = random.uniform() * area();
  // The rounding of the product may reach the end of the last triangle: step back to one with area.
  auto found = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end(), target);
  if (found == cumulative_area_.end()) found = std::lower_bound(cumulative_area_.begin(), found, area());
  const auto index = static_cast<std::size_t>(found - cumulative_area_.begin());
  const Triangle& triangle = triangles_[index];
  const double root = std::sqrt(random.uniform());
  const double share = random.uniform();
  return {.position = (1.0 - root) * triangle[0] + root * (1.0 - share) * triangle[1] + root * share * triangle[2],
          .triangle = index};
}

Eigen::Vector3d TriangleSampler::normal(std::size_t triangle) const {
  return doubled_area_vector(triangles_[triangle]).normalized();
}

}  // namespace cloud2csg
