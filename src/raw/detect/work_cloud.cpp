#include "raw/detect/work_cloud.hpp"

#include <algorithm>
#include <numeric>

namespace cloud2csg {
namespace {

/// Puts two zero bits before each of the low ten.
std::uint32_t spread(std::uint32_t v) {
  v = (v | (v << 16U)) & 0x030000FFU;
  v = (v | (v << 8U)) & 0x0300F00FU;
  v = (v | (v << 4U)) & 0x030C30C3U;
  return (v | (v << 2U)) & 0x09249249U;
}

std::uint32_t code_of(const Eigen::Vector3d& p, const AlignedBox& box, double edge) {
  constexpr double k_steps = 1 << WorkCloud::k_levels;
  const auto step = [&](int axis) {
    const double t = (p[axis] - box.min()[axis]) / edge * k_steps;
    return static_cast<std::uint32_t>(std::clamp(t, 0.0, k_steps - 1));
  };
  return spread(step(0)) | (spread(step(1)) << 1U) | (spread(step(2)) << 2U);
}

}  // namespace

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
  const std::size_t count = std::min(most, indices.size());
  std::vector<OrientedPoint> some;
  some.reserve(count);
  for (std::size_t k = 0; k < count; ++k) some.push_back(points[indices[k * indices.size() / count]]);
  return some;
}

WorkCloud make_work_cloud(const PointCloud& cloud) {
  const AlignedBox box = bounds_of(cloud.positions);
  WorkCloud work;
  work.middle = box.center();
  work.diagonal = std::max(box.diagonal().norm(), 1e-300);
  const double edge = std::max(box.sizes().maxCoeff(), 1e-300) * (1 + 1e-9);
  std::vector<std::uint32_t> codes(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) codes[i] = code_of(cloud.positions[i], box, edge);
  work.index.resize(cloud.size());
  std::iota(work.index.begin(), work.index.end(), 0U);
  std::ranges::stable_sort(work.index, {}, [&](std::uint32_t i) { return codes[i]; });
  work.code.reserve(cloud.size());
  work.points.reserve(cloud.size());
  for (const std::uint32_t i : work.index) {
    work.code.push_back(codes[i]);
    work.points.push_back({(cloud.positions[i] - work.middle) / work.diagonal, cloud.normals[i]});
  }
  return work;
}

}  // namespace cloud2csg
