#include "fitness/spatial_order.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace cloud2csg {
namespace {

constexpr double k_cells = 1024;
constexpr std::size_t k_chunk = 65'536;

/// Spreads ten bits three apart.
std::uint32_t spread(std::uint32_t value) {
  value = (value | value << 16U) & 0x030000ffU;
  value = (value | value << 8U) & 0x0300f00fU;
  value = (value | value << 4U) & 0x030c30c3U;
  return (value | value << 2U) & 0x09249249U;
}

std::uint32_t step(double offset, double cells_a_unit) {
  // The lower bound first: whatever the number, the result is in range.
  return spread(static_cast<std::uint32_t>(std::min(std::max(0.0, offset * cells_a_unit), k_cells - 1)));
}

}  // namespace

std::vector<std::uint32_t> spatial_order(PointsView positions, const AlignedBox& box, const RunContext& run) {
  const double cells_a_unit = k_cells / std::max(box.sizes().maxCoeff(), 1e-300);
  const Eigen::Vector3d& corner = box.min();
  const std::size_t count = positions.size();
  std::vector<std::uint64_t> keys(count);  // cell, then index
  for_each_index((count + k_chunk - 1) / k_chunk, run, [&](std::size_t chunk) {
    for (std::size_t i = chunk * k_chunk; i < std::min(count, (chunk + 1) * k_chunk); ++i) {
      const std::uint32_t cell = step(positions.x[i] - corner.x(), cells_a_unit) |
                                 step(positions.y[i] - corner.y(), cells_a_unit) << 1U |
                                 step(positions.z[i] - corner.z(), cells_a_unit) << 2U;
      keys[i] = std::uint64_t{cell} << 32U | i;
    }
  });
  sort_values(keys, run);
  std::vector<std::uint32_t> order(count);
  for_each_index((count + k_chunk - 1) / k_chunk, run, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * k_chunk);
    for (std::size_t i = chunk * k_chunk; i < end; ++i) order[i] = static_cast<std::uint32_t>(keys[i]);
  });
  return order;
}

}  // namespace cloud2csg
