#include "pipeline/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

constexpr double k_noted_surface = 0.005;     ///< share of the points: smaller surfaces may be left out
constexpr std::size_t k_points_tested = 200;  ///< that represent a surface

bool is_unused(const Extraction& result, const DetectedSurface& surface, double near) {
  const std::vector<std::uint32_t> tested = some_of(surface.points, k_points_tested);
  const std::vector<double> values =
      implicit_value(result.tree(), result.model.primitives, select_points(result.cloud.positions, tested));
  const auto far = std::ranges::count_if(values, [near](double value) { return std::abs(value) > near; });
  return 2 * static_cast<std::size_t>(far) > tested.size();
}

}  // namespace

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
