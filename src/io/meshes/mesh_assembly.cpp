#include "io/meshes/mesh_assembly.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_most_vertices = std::numeric_limits<std::uint32_t>::max();
/// A few seconds. Polygons of people's files, cogwheels with thousands of teeth too, take a thousandth of it.
constexpr std::size_t k_most_looks = 1'000'000'000;

}  // namespace

void check_coordinates(const FileContent& content, const Vector3d& position, FilePosition where) {
  if (position.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= std::numeric_limits<float>::max()) return;
  content.fail(where, fmt::format("expected finite coordinates of at most 3.4e38, found ({}, {}, {})", position.x(),
                                  position.y(), position.z()));
}

void MeshAssembly::add_vertex(std::span<const double> numbers, FilePosition where) {
  if (numbers.size() < 3) {
    content_.fail(where, fmt::format("expected coordinates x, y, z, found {} numbers", numbers.size()));
  }
  const Vector3d position(numbers[0], numbers[1], numbers[2]);
  check_coordinates(content_, position, where);
  if (vertex_count() == k_most_vertices) content_.fail(where, "expected fewer than 2^32 vertices, found more");
  mesh_.vertices.push_back(position);
}

void MeshAssembly::add_polygon(std::span<const double> corners, FilePosition where, std::size_t first) {
  ring_.clear();
  for (const double corner : corners) {
    const double index = corner - static_cast<double>(first);
    if (!(index >= 0.0 && index < static_cast<double>(vertex_count()) && index == std::floor(index))) {
      content_.fail(where, fmt::format("expected one of the {} vertices before, counted from {}, found {}",
                                       vertex_count(), first, corner));
    }
    ring_.push_back(static_cast<std::uint32_t>(index));
  }
  if (ring_.size() == 3) mesh_.triangles.push_back({ring_[0], ring_[1], ring_[2]});
  if (ring_.size() > 3) cut_ring(where);
}

/// Takes one ear after the other off, until three corners are left.
void MeshAssembly::cut_ring(FilePosition where) {
  const std::size_t count = ring_.size();
  const Points& points = mesh_.vertices;
  Vector3d normal = Vector3d::Zero();
  for (std::size_t i = 2; i < count; ++i) {
    normal += (points[ring_[i - 1]] - points[ring_[0]]).cross(points[ring_[i]] - points[ring_[0]]);
  }
  std::vector<std::size_t> before(count);
  std::vector<std::size_t> after(count);
  for (std::size_t i = 0; i < count; ++i) {
    before[i] = (i + count - 1) % count;
    after[i] = (i + 1) % count;
  }
  const auto ear_at = [&](std::size_t tip) { return std::array{ring_[before[tip]], ring_[tip], ring_[after[tip]]}; };
  // Only these corners can lie in an ear. There are none in a convex polygon, which becomes a fan.
  std::vector<std::uint32_t> inward;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(area(ear_at(i), normal) > 0.0)) inward.push_back(ring_[i]);
  }
  std::size_t tip = 1;
  std::size_t failures = 0;
  for (std::size_t left = count; left > 3;) {
    const std::array ear = ear_at(tip);
    looked_at_ += 1 + inward.size();
    if (looked_at_ > k_most_looks) {
      content_.fail(where, "the polygons have too many corners to cut them into triangles",
                    "let the program that wrote them do it");
    }
    // After a round without an ear the polygon is not simple: any cut will do.
    const bool is_simple = failures <= left;
    if (is_simple && (!(area(ear, normal) > 0.0) ||
                      std::ranges::any_of(inward, [&](std::uint32_t vertex) { return is_in(vertex, ear, normal); }))) {
      ++failures;
    } else {
      mesh_.triangles.push_back(ear);
      after[before[tip]] = after[tip];
      before[after[tip]] = before[tip];
      --left;
      if (is_simple) failures = 0;
    }
    tip = after[tip];
  }
  mesh_.triangles.push_back(ear_at(tip));
}

double MeshAssembly::area(const std::array<std::uint32_t, 3>& corners, const Vector3d& normal) const {
  const Vector3d a = mesh_.vertices[corners[0]];
  return normal.dot((mesh_.vertices[corners[1]] - a).cross(mesh_.vertices[corners[2]] - a));
}

bool MeshAssembly::is_in(std::uint32_t vertex, const std::array<std::uint32_t, 3>& ear, const Vector3d& normal) const {
  const Points& points = mesh_.vertices;
  // Where a hole is joined to the outside, two corners are at one place.
  if (std::ranges::any_of(ear, [&](std::uint32_t corner) { return points[corner] == points[vertex]; })) return false;
  return area({ear[0], ear[1], vertex}, normal) >= 0.0 && area({ear[1], ear[2], vertex}, normal) >= 0.0 &&
         area({ear[2], ear[0], vertex}, normal) >= 0.0;
}

}  // namespace cloud2csg
