#include "pipeline/close_unseen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/place_text.hpp"
#include "core/geometry/subset.hpp"
#include "raw/solids/unseen_surfaces.hpp"

namespace cloud2csg {
namespace {

/// Adds the side, if one is missing, to the cloud and to the surfaces.
void close_unseen_side(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  const std::optional<UnseenSide> side = find_unseen_side(cloud, found.detection.surfaces, found.prepared.scale, run);
  if (!side) return;
  DetectedSurface plane{.surface = {.position = side->points.positions[0], .axis = side->normal}, .points = {}};
  plane.points.resize(side->points.size());
  std::iota(plane.points.begin(), plane.points.end(), static_cast<std::uint32_t>(cloud.size()));
  found.added_points += side->points.size();
  append(cloud, side->points);
  found.detection.surfaces.push_back(std::move(plane));
  // Without digits that say nothing, and without a sign before zeros.
  const Eigen::Array3d facing = (1000 * side->normal.array()).round() / 1000 + 0.0;
  found.warnings.push_back(
      fmt::format("the side that faces ({:.3g}, {:.3g}, {:.3g}), {:.0f} % of the surface, has no points: it is closed "
                  "by a plane through {}",
                  facing.x(), facing.y(), facing.z(), 100 * side->share,
                  place_text(bounds_of(side->points.positions).center(), found.prepared.scale.diagonal)));
}

/// Adds the walls that nobody could see to the cloud, and their points to the surfaces.
void close_hidden_walls(FoundPrimitives& found, const RunContext& run) {
  PointCloud& cloud = found.prepared.cloud;
  const std::vector<HiddenWall> walls = find_hidden_walls(cloud, found.detection.surfaces, found.prepared.scale, run);
  if (walls.empty()) return;
  const auto largest = std::ranges::max_element(walls, {}, &HiddenWall::area);
  const Eigen::Vector3d middle = bounds_of(largest->points.positions).center();
  for (const HiddenWall& wall : walls) {
    std::vector<std::uint32_t>& own = found.detection.surfaces[wall.surface].points;
    own.resize(own.size() + wall.points.size());
    std::iota(own.end() - static_cast<std::ptrdiff_t>(wall.points.size()), own.end(),
              static_cast<std::uint32_t>(cloud.size()));
    found.added_points += wall.points.size();
    append(cloud, wall.points);
  }
  found.warnings.push_back(
      fmt::format("no sensor saw far into {} of the holes, the largest near {}: the walls are taken to go on between "
                  "what was seen of them",
                  walls.size(), place_text(middle, found.prepared.scale.diagonal)));
}

}  // namespace

FoundPrimitives with_unseen_closed(FoundPrimitives found, const RunContext& run) {
  close_unseen_side(found, run);
  close_hidden_walls(found, run);
  return found;
}

}  // namespace cloud2csg
