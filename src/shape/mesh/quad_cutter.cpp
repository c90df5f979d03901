#include "shape/mesh/quad_cutter.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

// Cosine of the angle between triangles up to which a quad counts as flat, so that either diagonal will do.
constexpr double k_flat = 0.99;
// Twice the area, in cells, below which a triangle is as good as none.
constexpr double k_no_area = 1e-6;
// Alignment of a triangle without area: worse than any cosine.
constexpr double k_without_area = -2.0;
// Difference of alignment below which the shorter diagonal decides.
constexpr double k_same = 1e-6;

}  // namespace

QuadCutter::Result QuadCutter::cut(std::span<const Quad> quads) const {
  Result result;
  result.triangles.reserve(2 * quads.size());
  const auto keep = [&result](const Cut& cut) {
    result.triangles.insert(result.triangles.end(), cut.triangles.begin(), cut.triangles.end());
  };
  std::vector<Cut> doubtful;        // two a quad
  std::vector<bool> prefers_first;  // of doubtful quads: by length
  for (const Quad& quad : quads) {
    const std::array<Cut, 2> cuts{cut_from(quad, 0), cut_from(quad, 1)};
    const bool first_is_shorter = squared_diagonal(quad, 0) <= squared_diagonal(quad, 1);
    if (is_flat(cuts)) {
      keep(cuts[first_is_shorter ? 0 : 1]);
    } else {
      doubtful.insert(doubtful.end(), cuts.begin(), cuts.end());
      prefers_first.push_back(first_is_shorter);
    }
  }
  const std::vector<double> aligned = alignments(doubtful);
  const auto worse = [&aligned](std::size_t cut) { return std::min(aligned[2 * cut], aligned[2 * cut + 1]); };
  for (std::size_t i = 0; i < prefers_first.size(); ++i) {
    const double gain = worse(2 * i) - worse(2 * i + 1);
    const bool first = std::abs(gain) > k_same ? gain > 0 : static_cast<bool>(prefers_first[i]);
    const std::size_t better = 2 * i + (first ? 0 : 1);
    keep(doubtful[better]);
    for (std::size_t k = 0; k < 2; ++k) {
      const double alignment = aligned[2 * better + k];
      if (alignment < 0 && alignment > k_without_area) result.folded.push_back(doubtful[better].triangles[k]);
    }
  }
  return result;
}

bool QuadCutter::is_flat(const std::array<Cut, 2>& cuts) const {
  const Eigen::Vector3d& normal = cuts[0].normals[0];
  const auto agrees = [&normal](const Eigen::Vector3d& other) { return normal.dot(other) > k_flat; };
  return agrees(cuts[0].normals[1]) && agrees(cuts[1].normals[0]) && agrees(cuts[1].normals[1]);
}

QuadCutter::Cut QuadCutter::cut_from(const Quad& quad, std::size_t start) const {
  const auto& v = quad.vertices;
  Cut cut{.triangles = {{{v[start], v[start + 1], v[start + 2]}, {v[start], v[start + 2], v[(start + 3) % 4]}}},
          .normals = {}};
  for (std::size_t i = 0; i < 2; ++i) cut.normals[i] = normal_of(cut.triangles[i]);
  return cut;
}

Eigen::Vector3d QuadCutter::normal_of(const Triangle& triangle) const {
  const Eigen::Vector3d& a = positions_[triangle[0]];
  const Eigen::Vector3d normal = (positions_[triangle[1]] - a).cross(positions_[triangle[2]] - a);
  const double length = normal.norm();
  return length > k_no_area ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d QuadCutter::centroid_of(const Triangle& triangle) const {
  return (positions_[triangle[0]] + positions_[triangle[1]] + positions_[triangle[2]]) / 3.0;
}

double QuadCutter::squared_diagonal(const Quad& quad, std::size_t start) const {
  return (positions_[quad.vertices[start + 2]] - positions_[quad.vertices[start]]).squaredNorm();
}

/// For each triangle of each cut how well it agrees with the surface there: the cosine between the normals.
std::vector<double> QuadCutter::alignments(std::span<const Cut> cuts) const {
  Points centroids;
  for (const Cut& cut : cuts) {
    for (const Triangle& triangle : cut.triangles) centroids.push_back(grid_.to_world(centroid_of(triangle)));
  }
  const Points gradients = implicit_gradient(tree_, primitives_, centroids);
  std::vector<double> result;
  result.reserve(2 * cuts.size());
  for (const Cut& cut : cuts) {
    for (const Eigen::Vector3d& normal : cut.normals) {
      const Eigen::Vector3d gradient = gradients[result.size()];
      result.push_back(normal.isZero() ? k_without_area : normal.dot(gradient.stableNormalized()));
    }
  }
  return result;
}

}  // namespace cloud2csg
