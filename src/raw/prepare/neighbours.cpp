#include "raw/prepare/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {

CentredPoints centred(PointsView points) {
  const AlignedBox box = bounds_of(points);
  CentredPoints result{Points(points.size()), box.isEmpty() ? Eigen::Vector3d::Zero().eval() : box.center().eval()};
  for (std::size_t i = 0; i < points.size(); ++i) result.points.set(i, points[i] - result.centre);
  return result;
}

namespace {

NeighbourTable empty_table(std::size_t rows, std::size_t width, std::size_t points) {
  NeighbourTable table{.width = std::min(width, points > 0 ? points - 1 : 0), .indices = {}, .distances = {}};
  table.indices.resize(rows * table.width);
  table.distances.resize(rows * table.width);
  return table;
}

void fill_row(NeighbourTable& table, std::size_t row, std::uint32_t point, const Points& points,
              const NeighbourTree& tree) {
  thread_local std::vector<std::uint32_t> indices;
  thread_local std::vector<double> squares;
  indices.resize(table.width + 1);
  squares.resize(table.width + 1);
  tree.find(points[point], indices, squares);
  // Among coincident points, the point itself may be missing from its neighbours. Then the farthest one is dropped.
  std::size_t to = row * table.width;
  const std::size_t full = to + table.width;
  for (std::size_t n = 0; n < indices.size() && to < full; ++n) {
    if (indices[n] == point) continue;
    table.indices[to] = indices[n];
    table.distances[to++] = static_cast<float>(std::sqrt(squares[n]));
  }
}

}  // namespace

NeighbourTable find_neighbours(const Points& points, const NeighbourTree& tree, std::size_t width,
                               const RunContext& run, const StageShare& share) {
  NeighbourTable table = empty_table(points.size(), width, points.size());
  const std::span<const std::uint32_t> order = tree.order();
  for_each_index_by_chunks(points.size(), k_chunk_points, run, share,
                           [&](std::size_t place) { fill_row(table, order[place], order[place], points, tree); });
  return table;
}

NeighbourTable find_neighbours_of(std::span<const std::uint32_t> some, const Points& points, const NeighbourTree& tree,
                                  std::size_t width, const RunContext& run) {
  NeighbourTable table = empty_table(some.size(), width, points.size());
  for_each_index_by_chunks(some.size(), k_chunk_points, run,
                           [&](std::size_t row) { fill_row(table, row, some[row], points, tree); });
  return table;
}

}  // namespace cloud2csg
