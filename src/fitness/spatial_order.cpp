#include "fitness/spatial_order.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "fitness/morton_curve.hpp"

namespace cloud2csg {
namespace {

constexpr int k_bits = 10;
constexpr std::size_t k_chunk = 65'536;

}  // namespace

std::vector<std::uint32_t> spatial_order(PointsView positions, const AlignedBox& box, const RunContext& run) {
  const MortonCurve curve(box, k_bits);
  const std::size_t count = positions.size();
  std::vector<std::uint64_t> keys(count);  // cell, then index
  for_each_index((count + k_chunk - 1) / k_chunk, run, [&](std::size_t chunk) {
    for (std::size_t i = chunk * k_chunk; i < std::min(count, (chunk + 1) * k_chunk); ++i) {
      const std::uint32_t cell = curve.cell_of(positions.x[i], positions.y[i], positions.z[i]);
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
