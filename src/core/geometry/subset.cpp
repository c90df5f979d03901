#include "core/geometry/subset.hpp"

#include <algorithm>

#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

std::vector<std::uint32_t> places_where(const std::vector<bool>& chosen, bool says) {
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i] == says) places.push_back(i);
  }
  return places;
}

std::vector<std::uint32_t> one_of_every_few(std::size_t count, std::size_t most, RandomStream random) {
  const std::size_t few = (count + most - 1) / most;
  std::vector<std::uint32_t> sample;
  for (std::size_t begin = 0; begin < count; begin += few) {
    sample.push_back(static_cast<std::uint32_t>(begin + random.below(std::min(few, count - begin))));
  }
  return sample;
}

PointCloud select_points(const PointCloud& cloud, std::span<const std::uint32_t> indices) {
  const auto select = [indices](const Points& points) {
    return points.empty() ? Points() : select_points(points, indices);
  };
  return {.positions = select(cloud.positions),
          .normals = select(cloud.normals),
          .sensor_positions = select(cloud.sensor_positions)};
}

}  // namespace cloud2csg
