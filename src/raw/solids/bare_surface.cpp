#include "raw/solids/bare_surface.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "cells/surface_samples.hpp"
#include "core/geometry/neighbour_tree.hpp"

namespace cloud2csg {
namespace {

constexpr double k_samples = 1000;      // of a primitive as large as the cloud, or smaller
constexpr double k_most_samples = 1e4;  // of a larger one
constexpr double k_step = 1e-4;         // in diagonals: to the places on either side that tell whether it is surface
constexpr double k_spacings = 6;        // to the nearest point, more than chance leaves

Points moved(const PointCloud& samples, double by) {
  Points places;
  places.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    places.push_back(samples.positions[i] + by * samples.normals[i]);
  }
  return places;
}

/// 1 in the solid, -1 outside, 0 where the places around disagree.
int side_by_places(const Eigen::Vector3d& place, const NeighbourTree& index, const LabelledPlaces& places) {
  constexpr std::size_t k_around = 16;  // agree by chance in 1 % of the cases at an edge
  std::array<std::uint32_t, k_around> near{};
  std::array<double, k_around> squares{};
  const std::span around = std::span(near).first(index.find(place, near, squares));
  const auto in = std::ranges::count_if(around, [&](std::uint32_t i) { return places.weights[i] > 0; });
  if (around.empty()) return 0;
  return in == 0 ? -1 : in == std::ssize(around) ? 1 : 0;
}

std::size_t samples_of(const AlignedBox& solid, const AlignedBox& cloud) {
  const auto area = [](const AlignedBox& box) {
    const Eigen::Vector3d size = box.sizes();
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  };
  return static_cast<std::size_t>(std::min(std::max(k_samples, k_samples * area(solid) / area(cloud)), k_most_samples));
}

}  // namespace

double BareSurface::share() const {
  return std::accumulate(shares.begin(), shares.end(), 0.0);
}

double bare_distance(double spacing, double tolerance) {
  return std::max(k_spacings * spacing, 2 * tolerance);
}

BareSurface find_bare_surface(const CsgTree& tree, const PrimitiveSet& solids, const Points& points, double near,
                              const RunContext& run) {
  const AlignedBox box = bounds_of(points);
  const double step = k_step * box.diagonal().norm();
  const NeighbourTree index(points);
  BareSurface bare;
  double area = 0;
  for (const PrimitiveIndex p : primitives_of(tree)) {
    run.throw_if_stopped();
    const AlignedBox reached = reach(solids[p], 0);
    const std::size_t count = samples_of(reached, box);
    const auto [samples, areas] = sample_surfaces({solids[p]}, std::span(&reached, 1), box,
                                                  {.base = count, .a_neighbour = 0, .most = count}, run);
    const std::vector<double> above = implicit_value(tree, solids, moved(samples, step));
    const std::vector<double> below = implicit_value(tree, solids, moved(samples, -step));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if ((above[i] < 0) == (below[i] < 0)) continue;
      area += areas[0];
      const double distance = index.nearest(samples.positions[i]).distance;
      if (distance <= near) continue;
      bare.samples.positions.push_back(samples.positions[i]);
      bare.samples.normals.push_back(samples.normals[i]);
      bare.shares.push_back(areas[0]);
      bare.distances.push_back(distance);
    }
  }
  for (double& share : bare.shares) share /= area;
  return bare;
}

LabelledPlaces places_beside(const BareSurface& bare, const LabelledPlaces& places, double depth) {
  LabelledPlaces beside;
  if (bare.shares.empty()) return beside;
  const NeighbourTree index(places.positions);
  for (const double by : {-depth, depth}) {
    const Points moves = moved(bare.samples, by);
    for (std::size_t i = 0; i < moves.size(); ++i) {
      const int side = side_by_places(moves[i], index, places);
      if (side == 0) continue;
      beside.positions.push_back(moves[i]);
      beside.weights.push_back(0.5 * side * bare.shares[i]);
    }
  }
  return beside;
}

}  // namespace cloud2csg
