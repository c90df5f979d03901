#include "pipeline/bare_surface.hpp"

#include <span>

#include "cells/surface_samples.hpp"
#include "core/geometry/neighbour_tree.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_samples = 400;  ///< of each primitive
constexpr double k_step = 1e-4;  ///< of the diagonal: so far off its surface a solid is looked at from both sides

/// The samples that are on the solid's surface, too.
Points on_surface(const PointCloud& samples, const CsgTree& tree, const PrimitiveSet& primitives, double step) {
  Points over;
  Points under;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    over.push_back(samples.positions[i] + step * samples.normals[i]);
    under.push_back(samples.positions[i] - step * samples.normals[i]);
  }
  const std::vector<double> above = implicit_value(tree, primitives, over);
  const std::vector<double> below = implicit_value(tree, primitives, under);
  Points result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if ((above[i] < 0) != (below[i] < 0)) result.push_back(samples.positions[i]);
  }
  return result;
}

}  // namespace

std::optional<BareSurface> find_bare_surface(const CsgTree& tree, const PrimitiveSet& primitives,
                                             const PointCloud& cloud, double near, const RunContext& run) {
  const AlignedBox box = bounds_of(cloud.positions);
  const NeighbourTree points(cloud.positions);
  BareSurface result;
  double all = 0;
  double bare = 0;
  double farthest = near;
  for (const PrimitiveIndex p : primitives_of(tree)) {
    run.throw_if_stopped();
    const AlignedBox reached = reach(primitives[p], 0);
    const SurfaceSamples samples =
        sample_surfaces({primitives[p]}, std::span(&reached, 1), box, {.base = k_samples, .a_neighbour = 0}, run);
    const Points places = on_surface(samples.points, tree, primitives, k_step * box.diagonal().norm());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance = points.nearest(places[i]).distance;
      all += samples.area_of_sample[0];
      if (distance <= near) continue;
      bare += samples.area_of_sample[0];
      if (distance <= farthest) continue;
      farthest = distance;
      result.middle = places[i];
    }
  }
  if (!(all > 0)) return std::nullopt;
  result.share = bare / all;
  return result;
}

}  // namespace cloud2csg
