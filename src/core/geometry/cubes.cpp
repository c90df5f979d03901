#include "core/geometry/cubes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/base/disjoint_sets.hpp"

namespace cloud2csg {
namespace {

constexpr int k_bits = 21;
constexpr std::int64_t k_offset = std::int64_t{1} << (k_bits - 1);

/// `cubes`: ascending keys. Neighbours along x differ by 1.
DisjointSets join_cubes(const std::vector<std::uint64_t>& cubes) {
  DisjointSets groups(cubes.size());
  // Half of the 26 neighbours, as rows along x. The other half joins from the neighbour's side.
  constexpr std::uint64_t k_row = std::uint64_t{1} << k_bits;
  constexpr std::uint64_t k_slice = k_row << k_bits;
  const auto join = [&](std::uint64_t first, std::uint64_t last) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      while (at < cubes.size() && cubes[at] < cubes[i] + first) ++at;
      for (std::size_t j = at; j < cubes.size() && cubes[j] <= cubes[i] + last; ++j) groups.join(i, j);
    }
  };
  join(1, 1);
  for (const std::uint64_t row : {k_row, k_slice - k_row, k_slice, k_slice + k_row}) join(row - 1, row + 1);
  return groups;
}

}  // namespace

std::uint64_t cube_of(const Eigen::Vector3d& place, double edge) {
  std::uint64_t key = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const auto step = static_cast<std::int64_t>(std::floor(place[axis] / edge)) + k_offset;
    key = key << static_cast<unsigned>(k_bits) | static_cast<std::uint64_t>(step);
  }
  return key;
}

std::vector<std::vector<std::uint32_t>> connected_groups(std::span<const std::uint64_t> cubes) {
  std::vector<std::uint64_t> distinct;
  std::unique_copy(cubes.begin(), cubes.end(), std::back_inserter(distinct));  // successive things are mostly near
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  DisjointSets group_of_cube = join_cubes(distinct);
  std::vector<std::vector<std::uint32_t>> groups(distinct.size());
  std::size_t group = 0;
  for (std::size_t k = 0; k < cubes.size(); ++k) {
    if (k == 0 || cubes[k] != cubes[k - 1]) {
      const auto cube = std::lower_bound(distinct.begin(), distinct.end(), cubes[k]) - distinct.begin();
      group = group_of_cube.root(static_cast<std::size_t>(cube));
    }
    groups[group].push_back(static_cast<std::uint32_t>(k));
  }
  std::erase_if(groups, [](const auto& g) { return g.empty(); });
  std::stable_sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace cloud2csg
