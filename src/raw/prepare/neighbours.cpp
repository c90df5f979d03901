#include "raw/prepare/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

void fill_row(NeighbourTable& table, std::uint32_t point, const Points& points, const NeighbourTree& tree) {
  thread_local std::vector<std::uint32_t> indices;
  thread_local std::vector<double> squares;
  indices.resize(table.width + 1);
  squares.resize(table.width + 1);
  tree.find(points[point], indices, squares);
  // The point itself may be missing from those found, because others coincide with it. Then the farthest one is
  // dropped.
  std::size_t to = point * table.width;
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
  NeighbourTable table{
      .width = std::min(width, std::max<std::size_t>(points.size(), 1) - 1), .indices = {}, .distances = {}};
  table.indices.resize(points.size() * table.width);
  table.distances.resize(points.size() * table.width);
  const std::span<const std::uint32_t> order = tree.order();
  for_each_index_by_chunks(points.size(), k_chunk_points, run, share,
                           [&](std::size_t place) { fill_row(table, order[place], points, tree); });
  return table;
}

std::vector<double> areas_of(const NeighbourTable& neighbours) {
  std::vector<double> areas;
  if (neighbours.width == 0) return areas;
  const std::size_t nearest = std::min(k_nearest, neighbours.width);
  for (std::size_t row = 0; row * neighbours.width < neighbours.indices.size(); ++row) {
    const double radius = neighbours.distances_of(row)[nearest - 1];
    areas.push_back(std::numbers::pi * radius * radius / static_cast<double>(nearest));
  }
  return areas;
}

}  // namespace cloud2csg
