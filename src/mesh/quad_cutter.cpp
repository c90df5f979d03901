#include "mesh/quad_cutter.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

// Cosine of the angle between triangles up to which a quad counts as flat, so that either diagonal will do.
constexpr double k_flat = 0.99;
// Twice the area, in cells, below which a triangle is as good as none.
constexpr double k_no_area = 1e-6;
// Difference of alignment below which the shorter diagonal decides.
constexpr double k_same = 1e-6;

}  // namespace

std::vector<Triangle> QuadCutter::cut(std::span<const Quad> quads) const {
  std::vector<Triangle> triangles;
  triangles.reserve(2 * quads.size());
  std::vector<Cut> doubtful;        // two a quad
  std::vector<bool> prefers_first;  // of doubtful quads: by length
  for (const Quad& quad : quads) {
    const std::array<Cut, 2> cuts{cut_from(quad, 0), cut_from(quad, 1)};
    const Eigen::Vector3d& normal = cuts[0].normals[0];
    const auto is_flat = [&normal](const Eigen::Vector3d& other) { return normal.dot(other) > k_flat; };
    const bool first_is_shorter = squared_diagonal(quad, 0) <= squared_diagonal(quad, 1);
    if (is_flat(cuts[0].normals[1]) && is_flat(cuts[1].normals[0]) && is_flat(cuts[1].normals[1])) {
      const Cut& shorter = cuts[first_is_shorter ? 0 : 1];
      triangles.insert(triangles.end(), shorter.triangles.begin(), shorter.triangles.end());
    } else {
      doubtful.insert(doubtful.end(), cuts.begin(), cuts.end());
      prefers_first.push_back(first_is_shorter);
    }
  }
  const std::vector<double> aligned = alignments(doubtful);
  for (std::size_t i = 0; i < prefers_first.size(); ++i) {
    const double gain = aligned[2 * i] - aligned[2 * i + 1];
    const bool first = std::abs(gain) > k_same ? gain > 0 : static_cast<bool>(prefers_first[i]);
    const Cut& better = doubtful[2 * i + (first ? 0 : 1)];
    triangles.insert(triangles.end(), better.triangles.begin(), better.triangles.end());
  }
  return triangles;
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

/// For each cut how well its worse triangle agrees with the surface there: the cosine between the normals; less than
/// any cosine for a triangle without area.
std::vector<double> QuadCutter::alignments(std::span<const Cut> cuts) const {
  constexpr double k_worst = -2.0;
  Points centroids;
  for (const Cut& cut : cuts) {
    for (const Triangle& triangle : cut.triangles) centroids.push_back(grid_.to_world(centroid_of(triangle)));
  }
  const Points gradients = implicit_gradient(tree_, primitives_, centroids);
  std::vector<double> result;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    double worst = 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector3d& normal = cuts[i].normals[k];
      const double cosine = normal.dot(gradients[2 * i + k].stableNormalized());
      worst = std::min(worst, normal.isZero() ? k_worst : cosine);
    }
    result.push_back(worst);
  }
  return result;
}

}  // namespace cloud2csg
