#include "raw/prepare/neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.hpp"

namespace cloud2csg {

CentredPoints centred(PointsView points) {
  const AlignedBox box = bounds_of(points);
  CentredPoints result{Points(points.size()), box.isEmpty() ? Eigen::Vector3d::Zero().eval() : box.center().eval()};
  for (std::size_t i = 0; i < points.size(); ++i) result.points.set(i, points[i] - result.centre);
  return result;
}

NeighbourTable find_neighbours(const Points& points, const NeighbourTree& tree, std::size_t width,
                               const RunContext& run, const StageShare& share) {
  const std::size_t count = points.size();
  NeighbourTable table{.width = std::min(width, count > 0 ? count - 1 : 0), .indices = {}, .distances = {}};
  table.indices.resize(count * table.width);
  table.distances.resize(count * table.width);
  if (table.width == 0) return table;
  const std::span<const std::uint32_t> order = tree.order();
  for_each_index_by_chunks(count, k_chunk_points, run, share, [&](std::size_t place) {
    thread_local std::vector<std::uint32_t> indices;
    thread_local std::vector<double> squares;
    indices.resize(table.width + 1);
    squares.resize(table.width + 1);
    const std::uint32_t i = order[place];
    tree.find(points[i], indices, squares);
    // Among coincident points, the point itself may be missing from its neighbours. Then the farthest one is dropped.
    std::size_t to = i * table.width;
    const std::size_t full = to + table.width;
    for (std::size_t n = 0; n < indices.size() && to < full; ++n) {
      if (indices[n] == i) continue;
      table.indices[to] = indices[n];
      table.distances[to++] = static_cast<float>(std::sqrt(squares[n]));
    }
  });
  return table;
}

}  // namespace cloud2csg
