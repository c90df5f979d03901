#include "cells/infinity.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_directions = 1024;
constexpr std::uint64_t k_infinity_stream = 0x696e66696e697479;

Eigen::Vector3d any_direction(RandomStream& random) {
  for (;;) {
    Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double square = direction.squaredNorm();
    if (square > 0 && square <= 1) return direction;
  }
}

}  // namespace

std::vector<Cell> cells_at_infinity(const PrimitiveSet& primitives) {
  std::vector<PrimitiveIndex> half_spaces;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
    if (std::holds_alternative<HalfSpace>(primitives[p].shape)) half_spaces.push_back(p);
  }
  if (half_spaces.empty()) return {Cell()};
  std::vector<Cell> cells;
  RandomStream random(0, k_infinity_stream);
  for (std::size_t i = 0; i < k_directions; ++i) {
    const Eigen::Vector3d direction = any_direction(random);
    Cell& cell = cells.emplace_back();
    for (const PrimitiveIndex p : half_spaces) {
      const Eigen::Vector3d outward = primitives[p].pose.orientation * Eigen::Vector3d::UnitZ();
      if (direction.dot(outward) < 0) cell.push_back(p);
    }
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace cloud2csg
