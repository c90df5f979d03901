#include "cloud2csg/advanced/winding_number.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

}  // namespace

std::vector<double> point_areas(const PointCloud& cloud, const RunContext& run) {
  const CentredPoints local = centred(cloud.positions);
  const NeighbourTree tree(local.points);
  const NeighbourTable neighbours = find_neighbours(local.points, tree, k_nearest, run);
  return neighbours.width == 0 ? std::vector<double>(cloud.size(), 0.0) : areas_of(neighbours);
}

double spacing_of(std::vector<double> areas) {
  return std::sqrt(median_of(areas));
}

WindingField::WindingField(PointsView positions, PointsView normals, std::span<const double> areas)
    : centre_(Vector3d::Zero()) {
  assert(positions.size() == normals.size() && positions.size() == areas.size());
  if (positions.empty()) return;
  centre_ = bounds_of(positions).center();
  dipoles_.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    dipoles_.push_back({.position = positions[i] - centre_,
                        .strength = areas[i] / (4.0 * std::numbers::pi) * normals[i],
                        .smoothing = areas[i] / std::numbers::pi});
  }
  nodes_.reserve(positions.size() / 2 + 1);
  build(0, dipoles_.size());
}

void WindingField::build(std::size_t first, std::size_t count) {
  const std::span<Dipole> group = std::span(dipoles_).subspan(first, count);
  AlignedBox box;
  double weight = 0.0;
  Vector3d middle = Vector3d::Zero();
  for (const Dipole& dipole : group) {
    box.extend(dipole.position);
    const double strength = dipole.strength.norm();
    weight += strength;
    middle += strength * dipole.position;
  }
  middle = weight > 0.0 ? (middle / weight).eval() : box.center().eval();
  Node node{.middle = middle,
            .strength = Vector3d::Zero(),
            .moment = Matrix3d::Zero(),
            .reach_square = 0.0,
            .first = static_cast<std::uint32_t>(first),
            .count = static_cast<std::uint32_t>(count),
            .skip = 0,
            .is_leaf = count <= k_nearest};
  for (const Dipole& dipole : group) {
    node.strength += dipole.strength;
    node.moment += (dipole.position - middle) * dipole.strength.transpose();
    const double reach = k_far_radii * (dipole.position - middle).norm() + std::sqrt(dipole.smoothing);
    node.reach_square = std::max(node.reach_square, reach * reach);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back(node);
  if (!node.is_leaf) {
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::size_t half = count / 2;
    std::nth_element(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(half), group.end(),
                     [axis](const Dipole& a, const Dipole& b) { return a.position[axis] < b.position[axis]; });
    build(first, half);
    build(first + half, count - half);
  }
  nodes_[index].skip = static_cast<std::uint32_t>(nodes_.size());
}

double WindingField::term(const Dipole& dipole, const Vector3d& place) {
  const Vector3d to = dipole.position - place;
  const double square = std::max(to.squaredNorm(), dipole.smoothing);
  return square > 0.0 ? dipole.strength.dot(to) / (square * std::sqrt(square)) : 0.0;
}

double WindingField::at(const Vector3d& place) const {
  const Vector3d local = place - centre_;
  double sum = 0.0;
  for (std::size_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const Vector3d to = node.middle - local;
    const double square = to.squaredNorm();
    if (square > node.reach_square) {
      const double cube = 1.0 / (square * std::sqrt(square));
      sum += cube * (node.strength.dot(to) + node.moment.trace() - 3.0 / square * to.dot(node.moment * to));
      n = node.skip;
      continue;
    }
    if (node.is_leaf) {
      for (std::uint32_t i = 0; i < node.count; ++i) sum += term(dipoles_[node.first + i], local);
    }
    ++n;
  }
  return sum;
}

double WindingField::exact(const Vector3d& place) const {
  double sum = 0.0;
  for (const Dipole& dipole : dipoles_) sum += term(dipole, place - centre_);
  return sum;
}

std::vector<double> winding_numbers(const PointCloud& cloud, PointsView places, const RunContext& run) {
  assert(cloud.has_normals());
  const WindingField field(cloud.positions, cloud.normals, point_areas(cloud, run));
  std::vector<double> numbers(places.size());
  for_each_index_by_chunks(places.size(), k_chunk_points, run,
                           [&](std::size_t i) { numbers[i] = field.at(places[i]); });
  return numbers;
}

}  // namespace cloud2csg
