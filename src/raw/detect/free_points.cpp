#include "raw/detect/free_points.hpp"

#include <algorithm>
#include <numeric>

namespace cloud2csg {

FreePoints::FreePoints(const WorkCloud& cloud) : cloud_(cloud), is_free_(cloud.size(), true), list_(cloud.size()) {
  std::iota(list_.begin(), list_.end(), 0U);
}

void FreePoints::take(std::span<const std::uint32_t> points) {
  for (const std::uint32_t i : points) is_free_[i] = false;
  std::erase_if(list_, [&](std::uint32_t i) { return !is_free_[i]; });
}

std::vector<OrientedPoint> FreePoints::draw(std::size_t count, RandomStream& random) const {
  std::vector<OrientedPoint> drawn(std::min(count, list_.size()));
  std::generate(drawn.begin(), drawn.end(), [&] { return cloud_.points[list_[random.below(list_.size())]]; });
  return drawn;
}

std::vector<OrientedPoint> FreePoints::draw_neighbours(std::size_t count, RandomStream& random) const {
  const std::uint32_t middle = list_[random.below(list_.size())];
  // From half of the cloud's length to 1/256 of it: large surfaces show in large cells, small ones in small cells.
  const int level = 1 + static_cast<int>(random.below(8));
  const auto [first, last] = cloud_.cell_of(middle, level);
  std::vector<OrientedPoint> drawn{cloud_.points[middle]};
  for (std::size_t tries = 0; tries < 2 * count && drawn.size() < count; ++tries) {
    const std::uint32_t i = first + random.below(last - first);
    if (i != middle && is_free_[i]) drawn.push_back(cloud_.points[i]);
  }
  return drawn;
}

}  // namespace cloud2csg
