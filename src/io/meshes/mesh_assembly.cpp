#include "io/meshes/mesh_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/facet.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_most_repeated = 10'000'000;
/// A few seconds. Real polygons, even cogwheels with thousands of teeth, take a thousandth of it.
constexpr std::size_t k_most_looks = 1'000'000'000;

}  // namespace

void MeshAssembly::start_part(const Eigen::Affine3d& motion) {
  motion_ = motion;
  mirrors_ = motion.linear().determinant() < 0.0;
  part_begin_ = mesh_.vertices.size();
  constexpr std::size_t k_like_vertices = 16;  // a part costs about as much time
  grow(k_like_vertices);
}

void MeshAssembly::grow(std::size_t things) {
  size_ += things;
  if (size_ > k_most_repeated + content_.bytes().size() || size_ > std::numeric_limits<std::uint32_t>::max()) {
    content_.fail("the mesh is too large: parts are repeated too often", "write each part to its own file");
  }
}

void MeshAssembly::add_vertex(std::span<const double> numbers, FilePosition where) {
  if (numbers.size() < 3) {
    content_.fail(where, fmt::format("expected coordinates x, y, z, found {} numbers", numbers.size()));
  }
  const Vector3d position = motion_ * Vector3d(numbers[0], numbers[1], numbers[2]);
  // Squares of larger coordinates may not be finite.
  if (!(position.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= std::numeric_limits<float>::max())) {
    content_.fail(where, fmt::format("expected finite coordinates of at most 3.4e38, found ({}, {}, {})", numbers[0],
                                     numbers[1], numbers[2]));
  }
  grow(1);
  mesh_.vertices.push_back(position);
}

void MeshAssembly::add_polygon(std::span<const double> corners, FilePosition where, std::size_t first) {
  ring_.clear();
  for (const double corner : corners) {
    const double index = corner - static_cast<double>(first);
    if (!(index >= 0.0 && index < static_cast<double>(vertex_count()) && index == std::floor(index))) {
      content_.fail(where, fmt::format("expected the index of one of the {} vertices so far, counted from {}, found {}",
                                       vertex_count(), first, corner));
    }
    ring_.push_back(static_cast<std::uint32_t>(part_begin_ + static_cast<std::size_t>(index)));
  }
  if (ring_.size() == 3) add_triangle({ring_[0], ring_[1], ring_[2]});
  if (ring_.size() > 3) cut_ring(where);
}

void MeshAssembly::add_triangle(const Corners& corners) {
  const auto& [a, b, c] = corners;
  grow(1);
  mesh_.triangles.push_back(mirrors_ ? Corners{a, c, b} : corners);
}

/// Ear clipping: cuts off ears until three corners are left.
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
  const auto ear_at = [&](std::size_t tip) { return Corners{ring_[before[tip]], ring_[tip], ring_[after[tip]]}; };
  // Only reflex or flat corners can lie in an ear. A convex polygon has none and becomes a fan.
  std::vector<std::uint32_t> inward;
  for (std::size_t i = 0; i < count; ++i) {
    if (!(area(ear_at(i), normal) > 0.0)) inward.push_back(ring_[i]);
  }
  std::size_t tip = 1;
  std::size_t failures = 0;
  for (std::size_t left = count; left > 3;) {
    const Corners ear = ear_at(tip);
    looked_at_ += 1 + inward.size();
    if (looked_at_ > k_most_looks) {
      content_.fail(where, "the polygons have too many corners to cut them into triangles",
                    "cut the polygons into triangles in the program that wrote them");
    }
    // A full round without an ear means the polygon is not simple. Then any cut will do.
    const bool is_simple = failures <= left;
    if (is_simple && (!(area(ear, normal) > 0.0) ||
                      std::ranges::any_of(inward, [&](std::uint32_t vertex) { return is_in(vertex, ear, normal); }))) {
      ++failures;
    } else {
      add_triangle(ear);
      after[before[tip]] = after[tip];
      before[after[tip]] = before[tip];
      --left;
      if (is_simple) failures = 0;
    }
    tip = after[tip];
  }
  add_triangle(ear_at(tip));
}

double MeshAssembly::area(const Corners& corners, const Vector3d& normal) const {
  return normal.dot(doubled_area(mesh_, corners));
}

bool MeshAssembly::is_in(std::uint32_t vertex, const Corners& ear, const Vector3d& normal) const {
  const Points& points = mesh_.vertices;
  // A bridge from a hole to the outline has two corners at one place.
  if (std::ranges::any_of(ear, [&](std::uint32_t corner) { return points[corner] == points[vertex]; })) return false;
  return area({ear[0], ear[1], vertex}, normal) >= 0.0 && area({ear[1], ear[2], vertex}, normal) >= 0.0 &&
         area({ear[2], ear[0], vertex}, normal) >= 0.0;
}

}  // namespace cloud2csg
