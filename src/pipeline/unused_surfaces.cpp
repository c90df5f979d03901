#include "pipeline/unused_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cloud2csg {
namespace {

constexpr std::size_t k_sample = 200;  // points of a surface that tell

bool is_unused(const CsgTree& tree, const PrimitiveSet& solids, const PointCloud& cloud, const DetectedSurface& surface,
               double near) {
  const std::size_t count = std::min(k_sample, surface.points.size());
  Points places;
  for (std::size_t k = 0; k < count; ++k) {
    places.push_back(cloud.positions[surface.points[k * surface.points.size() / count]]);
  }
  const std::vector<double> values = implicit_value(tree, solids, places);
  const auto far = std::ranges::count_if(values, [near](double value) { return std::abs(value) > near; });
  return 2 * static_cast<std::size_t>(far) > count;
}

}  // namespace

UnusedSurfaces find_unused_surfaces(const CsgTree& tree, const PrimitiveSet& solids, const PointCloud& cloud,
                                    std::span<const DetectedSurface> surfaces, double near, std::size_t least_points) {
  UnusedSurfaces unused;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].points.size() < least_points || !is_unused(tree, solids, cloud, surfaces[s], near)) continue;
    if (unused.count == 0 || surfaces[s].points.size() > surfaces[unused.largest].points.size()) unused.largest = s;
    ++unused.count;
  }
  return unused;
}

}  // namespace cloud2csg
