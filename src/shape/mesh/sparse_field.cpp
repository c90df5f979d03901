#include "shape/mesh/sparse_field.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/parallel.hpp"
#include "shape/mesh/interval_tree.hpp"

namespace cloud2csg {
namespace {

/// Cells between the solid's bounds and the border of the grid.
constexpr int k_margin = 2;
// Against rounding in centres and distances, relative to the size of the grid.
constexpr double k_safety = 1e-9;

Grid grid_around(const AlignedBox& bounds, int resolution) {
  const double spacing = bounds.sizes().maxCoeff() / resolution;
  const Eigen::Vector3d shift(std::numbers::sqrt2 - 1.0, std::numbers::sqrt3 - 1.0, std::numbers::phi - 1.0);
  Grid grid{.origin = bounds.min() - spacing * (Eigen::Vector3d::Constant(k_margin) + shift),
            .spacing = spacing,
            .blocks = {}};
  for (int axis = 0; axis < 3; ++axis) {
    const int cells = static_cast<int>(std::ceil(bounds.sizes()[axis] / spacing)) + 2 * k_margin + 2;
    grid.blocks[axis] = (cells + k_block_cells - 1) / k_block_cells;
  }
  return grid;
}

/// Signs at the corners that a block owns.
std::bitset<k_block_corners> corner_signs(const Block& block, const Grid& grid, const PrimitiveSet& primitives) {
  Points corners;
  corners.reserve(k_block_corners);
  for (int z = 0; z < k_block_cells; ++z) {
    for (int y = 0; y < k_block_cells; ++y) {
      for (int x = 0; x < k_block_cells; ++x) {
        corners.push_back(grid.to_world((block.first_cell + Eigen::Vector3i(x, y, z)).cast<double>()));
      }
    }
  }
  const std::vector<double> values = implicit_value(block.tree, primitives, corners);
  std::bitset<k_block_corners> inside;
  for (std::size_t i = 0; i < values.size(); ++i) inside[i] = values[i] < 0;
  return inside;
}

/// A box of blocks and the tree that holds within.
struct Region {
  Eigen::Vector3i low;   ///< first block
  Eigen::Vector3i high;  ///< one past the last block
  std::vector<CsgNode> tree;

  [[nodiscard]] bool is_block() const { return (high - low).maxCoeff() == 1; }
  [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * k_block_cells * (low + high).cast<double>(); }
  /// From the centre to the corners, in cells.
  [[nodiscard]] double radius() const { return 0.5 * k_block_cells * (high - low).cast<double>().norm(); }
};

std::vector<Region> halves(const Region& region) {
  std::vector<Region> parts{region};
  for (int axis = 0; axis < 3; ++axis) {
    if (region.high[axis] - region.low[axis] < 2) continue;
    const int middle = (region.low[axis] + region.high[axis]) / 2;
    const std::size_t count = parts.size();
    for (std::size_t i = 0; i < count; ++i) {
      parts.push_back(parts[i]);
      parts[i].high[axis] = middle;
      parts.back().low[axis] = middle;
    }
  }
  return parts;
}

}  // namespace

/// Halves the grid again and again; parts that are all inside or all outside are done, single blocks are kept.
class SparseField::Subdivision {
 public:
  Subdivision(SparseField& field, const BoundedSolid& solid)
      : field_(field), primitives_(solid.primitives), intervals_(solid.primitives.size()) {
    const auto nodes = solid.tree.nodes();
    Region all{.low = Eigen::Vector3i::Zero(), .high = field.grid_.blocks, .tree = {nodes.begin(), nodes.end()}};
    classify({std::move(all)});
  }

  void run() {
    while (!pending_.empty()) {
      const Region region = std::move(pending_.back());
      pending_.pop_back();
      classify(halves(region));
    }
  }

 private:
  /// Siblings have the same tree, so one batch a primitive evaluates all their centres.
  void classify(std::vector<Region> regions) {
    Points centres;
    for (const Region& region : regions) centres.push_back(field_.grid_.to_world(region.centre()));
    const std::vector<PrimitiveIndex> used = primitives_of(CsgTree(regions.front().tree));
    std::vector<std::vector<double>> values;
    values.reserve(used.size());
    for (const PrimitiveIndex index : used) values.push_back(signed_distance(primitives_[index], centres));
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const auto within = [&](double cells) {
        const double radius = cells * field_.grid_.spacing * (1.0 + k_safety);
        for (std::size_t u = 0; u < used.size(); ++u) {
          intervals_[used[u]] = value_near(primitives_[used[u]], values[u][i], radius);
        }
        return prune(regions[i].tree, intervals_);
      };
      const Interval value = within(regions[i].radius()).value;
      if (value.low > 0 || value.high < 0) {
        fill(regions[i], value.low > 0 ? k_all_outside : k_all_inside);
        continue;
      }
      regions[i].tree = within(regions[i].radius() + std::numbers::sqrt3 * k_block_reach).nodes;
      if (regions[i].is_block()) {
        keep(regions[i]);
      } else {
        pending_.push_back(std::move(regions[i]));
      }
    }
  }

  void keep(const Region& region) {
    field_.slots_[field_.slot_position(region.low)] = static_cast<int>(field_.blocks_.size());
    field_.blocks_.push_back({.first_cell = k_block_cells * region.low, .tree = CsgTree(region.tree), .inside = {}});
  }

  void fill(const Region& region, int state) {
    for (int z = region.low.z(); z < region.high.z(); ++z) {
      for (int y = region.low.y(); y < region.high.y(); ++y) {
        for (int x = region.low.x(); x < region.high.x(); ++x) field_.slots_[field_.slot_position({x, y, z})] = state;
      }
    }
  }

  SparseField& field_;
  const PrimitiveSet& primitives_;
  std::vector<Interval> intervals_;  ///< by primitive
  std::vector<Region> pending_ = {};
};

SparseField::SparseField(const BoundedSolid& solid, int resolution, const RunContext& run)
    : grid_(grid_around(solid.bounds, resolution)),
      slots_(slot_position(grid_.blocks - Eigen::Vector3i::Ones()) + 1, k_all_outside) {
  run.throw_if_stopped();
  Subdivision(*this, solid).run();
  for_each_index(blocks_.size(), run,
                 [&](std::size_t i) { blocks_[i].inside = corner_signs(blocks_[i], grid_, solid.primitives); });
}

bool SparseField::inside(const Eigen::Vector3i& corner) const {
  // Upper corners of the last cells; the margin is outside.
  if ((corner.array() >= k_block_cells * grid_.blocks.array()).any()) return false;
  const int slot = slot_of(corner);
  if (slot < 0) return slot == k_all_inside;
  const Block& block = blocks_[static_cast<std::size_t>(slot)];
  return block.inside[static_cast<std::size_t>(Block::local_index(corner - block.first_cell))];
}

}  // namespace cloud2csg
