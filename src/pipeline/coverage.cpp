#include "pipeline/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "cells/surface_samples.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_samples = 400;  ///< per primitive
constexpr double k_step = 1e-4;  ///< share of the diagonal: distance of the two test points on either side of a surface
constexpr double k_bare_spacings = 6;         ///< a surface this many spacings from all points is bare
constexpr double k_noted_surface = 0.005;     ///< share of the points: smaller surfaces may be left out
constexpr std::size_t k_points_tested = 200;  ///< that represent a surface

/// The samples that lie on the solid's surface.
Points on_surface(const PointCloud& samples, const Model& model, double step) {
  Points over;
  Points under;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    over.push_back(samples.positions[i] + step * samples.normals[i]);
    under.push_back(samples.positions[i] - step * samples.normals[i]);
  }
  const std::vector<double> above = implicit_value(*model.tree, model.primitives, over);
  const std::vector<double> below = implicit_value(*model.tree, model.primitives, under);
  Points result;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if ((above[i] < 0) != (below[i] < 0)) result.push_back(samples.positions[i]);
  }
  return result;
}

bool is_unused(const Extraction& result, const DetectedSurface& surface, double near) {
  const std::vector<std::uint32_t> tested = some_of(surface.points, k_points_tested);
  const std::vector<double> values =
      implicit_value(result.tree(), result.model.primitives, select_points(result.cloud.positions, tested));
  const auto far = std::ranges::count_if(values, [near](double value) { return std::abs(value) > near; });
  return 2 * static_cast<std::size_t>(far) > tested.size();
}

}  // namespace

std::optional<BareSurface> find_bare_surface(const Extraction& result, const RunContext& run) {
  const PrimitiveSet& primitives = result.model.primitives;
  const FindingStatistics& finding = *result.statistics.finding;
  const double near = std::max(k_bare_spacings * finding.spacing, 2 * finding.tolerance);
  const AlignedBox box = bounds_of(result.cloud.positions);
  const NeighbourTree points(result.cloud.positions);
  BareSurface found;
  double all = 0;
  double bare = 0;
  double farthest = near;
  for (const PrimitiveIndex p : primitives_of(result.tree())) {
    run.throw_if_stopped();
    const AlignedBox reached = reach(primitives[p], 0);
    const SurfaceSamples samples =
        sample_surfaces({primitives[p]}, std::span(&reached, 1), box, {.base = k_samples, .a_neighbour = 0}, run);
    const Points places = on_surface(samples.points, result.model, k_step * box.diagonal().norm());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance = points.nearest(places[i]).distance;
      all += samples.area_of_sample[0];
      if (distance <= near) continue;
      bare += samples.area_of_sample[0];
      if (distance <= farthest) continue;
      farthest = distance;
      found.middle = places[i];
    }
  }
  if (!(all > 0)) return std::nullopt;
  found.share = bare / all;
  return found;
}

UnusedSurfaces find_unused_surfaces(const Extraction& result) {
  const double near = 2 * result.statistics.finding->tolerance;
  const auto least_points = static_cast<std::size_t>(k_noted_surface * static_cast<double>(result.cloud.size()));
  const std::vector<DetectedSurface>& surfaces = result.surfaces;
  UnusedSurfaces unused;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].points.size() < least_points || !is_unused(result, surfaces[s], near)) continue;
    if (unused.count == 0 || surfaces[s].points.size() > surfaces[unused.largest].points.size()) unused.largest = s;
    ++unused.count;
  }
  return unused;
}

}  // namespace cloud2csg
