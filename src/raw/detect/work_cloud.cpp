#include "raw/detect/work_cloud.hpp"

#include <algorithm>
#include <numeric>

#include "core/geometry/spatial_order.hpp"
#include "core/geometry/subset.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {

std::pair<std::uint32_t, std::uint32_t> WorkCloud::cell_of(std::uint32_t i, int level) const {
  const int shift = 3 * (k_levels - level);
  const std::uint32_t low = (code[i] >> shift) << shift;
  const std::uint32_t high = low + (std::uint32_t{1} << shift);
  const auto first = std::lower_bound(code.begin(), code.end(), low);
  const auto last = std::lower_bound(first, code.end(), high);
  return {static_cast<std::uint32_t>(first - code.begin()), static_cast<std::uint32_t>(last - code.begin())};
}

double WorkCloud::extent_of(const std::vector<std::uint32_t>& indices) const {
  AlignedBox box;
  for (const std::uint32_t i : indices) box.extend(points[i].position);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

Points WorkCloud::positions() const {
  Points all(size());
  for (std::uint32_t i = 0; i < size(); ++i) all.set(i, points[i].position);
  return all;
}

Points WorkCloud::positions_of(const std::vector<std::uint32_t>& indices) const {
  Points positions(indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k) positions.set(k, points[indices[k]].position);
  return positions;
}

NeighbourTable WorkCloud::neighbours(const RunContext& run) const {
  const Points all = positions();
  return find_neighbours(all, NeighbourTree(all), k_around, run);
}

std::vector<OrientedPoint> WorkCloud::some_of(std::span<const std::uint32_t> indices, std::size_t most) const {
  std::vector<OrientedPoint> some;
  for (const std::uint32_t i : cloud2csg::some_of(indices, most)) some.push_back(points[i]);
  return some;
}

WorkCloud make_work_cloud(const PointCloud& cloud) {
  const AlignedBox box = bounds_of(cloud.positions);
  WorkCloud work;
  work.middle = box.center();
  work.diagonal = std::max(box.diagonal().norm(), 1e-300);
  // Enlarged slightly, so that no point is on the upper border.
  const double edge = std::max(box.sizes().maxCoeff(), 1e-300) * (1 + 1e-9);
  const MortonCurve curve(box.min(), edge, WorkCloud::k_levels);
  work.index = spatial_order(cloud.positions, curve, {.threads = 1});
  work.code.reserve(cloud.size());
  work.points.reserve(cloud.size());
  for (const std::uint32_t i : work.index) {
    const Eigen::Vector3d position = cloud.positions[i];
    work.code.push_back(curve.cell_of(position.x(), position.y(), position.z()));
    work.points.push_back({(position - work.middle) / work.diagonal, cloud.normals[i]});
  }
  work.runs = runs_of(work.points);
  return work;
}

std::vector<PointRun> runs_of(std::span<const OrientedPoint> points) {
  constexpr double k_rounding = 1e-12;  // of distances, in a cloud of diagonal 1
  std::vector<PointRun> runs;
  for (std::size_t first = 0; first < points.size(); first += k_chunk_points) {
    const std::size_t last = std::min(first + k_chunk_points, points.size());
    AlignedBox box;
    double precision = 1;
    for (const OrientedPoint& p : points.subspan(first, last - first)) {
      box.extend(p.position);
      precision = std::min(precision, p.precision);
    }
    runs.push_back({.first = static_cast<std::uint32_t>(first),
                    .last = static_cast<std::uint32_t>(last),
                    .middle = box.center(),
                    .radius = 0.5 * box.diagonal().norm() + k_rounding,
                    .precision = precision});
  }
  return runs;
}

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
  // From half of the cloud's length to 1/256 of it, so that cells match large and small surfaces.
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
