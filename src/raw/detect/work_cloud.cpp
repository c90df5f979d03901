#include "raw/detect/work_cloud.hpp"

#include <algorithm>

#include "core/geometry/spatial_order.hpp"
#include "core/geometry/subset.hpp"

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

std::vector<OrientedPoint> WorkCloud::some_of(const std::vector<std::uint32_t>& indices, std::size_t most) const {
  std::vector<OrientedPoint> some;
  for (const std::uint32_t i : cloud2csg::some_of(indices, most)) some.push_back(points[i]);
  return some;
}

WorkCloud make_work_cloud(const PointCloud& cloud) {
  const AlignedBox box = bounds_of(cloud.positions);
  WorkCloud work;
  work.middle = box.center();
  work.diagonal = std::max(box.diagonal().norm(), 1e-300);
  // A little more than the points take up, so that none is on the far border.
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
  return work;
}

}  // namespace cloud2csg
