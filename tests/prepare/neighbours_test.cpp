#include "raw/prepare/neighbours.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

/// On a coarse grid, so that many coincide.
Points random_points(std::size_t count, RandomStream& random) {
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto coordinate = [&] { return static_cast<double>(random.below(5)); };
    const double x = coordinate();
    const double y = coordinate();
    points.set(i, {x, y, coordinate()});
  }
  return points;
}

/// Distances from point `row` to all others, ascending.
std::vector<float> plain_distances(std::size_t row, const Points& points) {
  std::vector<float> distances;
  for (std::size_t j = 0; j < points.size(); ++j) {
    if (j != row) distances.push_back(static_cast<float>((points[j] - points[row]).norm()));
  }
  std::ranges::sort(distances);
  return distances;
}

RC_GTEST_PROP(FindNeighbours, AreTheNearestOthers, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const Points points = random_points(1 + random.below(300), random);
  const std::size_t width = 1 + random.below(12);
  const NeighbourTable table = find_neighbours(points, NeighbourTree(points), width, {.threads = 2});
  RC_ASSERT(table.width == std::min(width, points.size() - 1));
  for (std::size_t row = 0; row < points.size(); ++row) {
    const std::vector<float> plain = plain_distances(row, points);
    for (std::size_t n = 0; n < table.width; ++n) {
      const std::uint32_t j = table.of(row)[n];
      RC_ASSERT(j != row);
      RC_ASSERT(std::ranges::count(table.of(row), j) == 1);
      RC_ASSERT(table.distances_of(row)[n] == plain[n]);
      RC_ASSERT(table.distances_of(row)[n] == static_cast<float>((points[j] - points[row]).norm()));
    }
  }
}

}  // namespace
}  // namespace cloud2csg
