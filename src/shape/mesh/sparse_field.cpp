#include "shape/mesh/sparse_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/base/parallel.hpp"
#include "core/fields/bounded_field.hpp"
#include "core/fields/lipschitz.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

struct Interval {
  double low;
  double high;
};

struct PrunedTree {
  std::vector<CsgNode> nodes;  ///< postfix, without branches that cannot decide the value
  Interval value;
};

constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// A pruned subtree, from `begin` to the next operand's begin or the end of the output.
struct Operand {
  std::size_t begin;
  Interval value;
};

Interval negated(Interval a) {
  return {.low = -a.high, .high = -a.low};
}

class Pruner {
 public:
  explicit Pruner(std::span<const Interval> primitive_values) : primitive_values_(primitive_values) {}

  PrunedTree prune(std::span<const CsgNode> tree) {
    for (const CsgNode& node : tree) add(node);
    return {.nodes = std::move(output_), .value = stack_.back().value};
  }

 private:
  void add(const CsgNode& node) {
    switch (node.operation()) {
      case Operation::primitive:
        return add_leaf(node, primitive_values_[node.primitive()]);
      case Operation::empty:
        return add_leaf(node, {.low = k_infinity, .high = k_infinity});
      case Operation::full:
        return add_leaf(node, {.low = -k_infinity, .high = -k_infinity});
      case Operation::complement:
        stack_.back().value = negated(stack_.back().value);
        return add_inner(node.operation());
      case Operation::union_of:
        return add_union();
      case Operation::intersection:
        return add_intersection(false);
      case Operation::difference:
        return add_intersection(true);
    }
  }

  void add_leaf(const CsgNode& node, Interval value) {
    stack_.push_back({.begin = output_.size(), .value = value});
    output_.push_back(node);
  }

  void add_inner(Operation operation) {
    const std::size_t length = output_.size() - stack_.back().begin + 1;
    output_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(length)));
  }

  /// min(a, b)
  void add_union() {
    const Operand b = stack_.back();
    stack_.pop_back();
    Operand& a = stack_.back();
    if (a.value.high < b.value.low) return drop_second(b);
    if (b.value.high < a.value.low) return drop_first(b);
    a.value = {.low = std::min(a.value.low, b.value.low), .high = std::min(a.value.high, b.value.high)};
    add_inner(Operation::union_of);
  }

  /// max(a, b), or max(a, -b)
  void add_intersection(bool is_difference) {
    const Operand b = stack_.back();
    const Interval b_value = is_difference ? negated(b.value) : b.value;
    stack_.pop_back();
    Operand& a = stack_.back();
    if (a.value.low > b_value.high) return drop_second(b);
    if (b_value.low > a.value.high) {
      drop_first({.begin = b.begin, .value = b_value});
      if (is_difference) add_inner(Operation::complement);
      return;
    }
    a.value = {.low = std::max(a.value.low, b_value.low), .high = std::max(a.value.high, b_value.high)};
    add_inner(is_difference ? Operation::difference : Operation::intersection);
  }

  void drop_second(const Operand& b) { output_.erase(at(b.begin), output_.end()); }

  void drop_first(const Operand& b) {
    Operand& a = stack_.back();
    output_.erase(at(a.begin), at(b.begin));
    a.value = b.value;
  }

  std::vector<CsgNode>::iterator at(std::size_t index) { return output_.begin() + static_cast<std::ptrdiff_t>(index); }

  std::span<const Interval> primitive_values_;
  std::vector<Operand> stack_ = {};
  std::vector<CsgNode> output_ = {};
};

/// Bounds of the implicit value within `radius` of a point where it is `value`.
Interval value_near(const Primitive& primitive, double value, double radius) {
  if (std::isnan(value)) return {.low = -k_infinity, .high = k_infinity};
  double change = lipschitz_bound(primitive) * radius;
  // A displacement never changes by more than 2, whatever its frequency.
  if (primitive.displacement && !std::holds_alternative<Expression>(primitive.shape)) {
    change = std::min(change, radius + 2.0);
  }
  return {.low = value - change, .high = value + change};
}

/// Restricts the tree to a region with known bounds on each primitive's value (by primitive index). Values there stay
/// exactly equal. In a small region most of a large tree vanishes.
PrunedTree prune(std::span<const CsgNode> tree, std::span<const Interval> primitive_values) {
  return Pruner(primitive_values).prune(tree);
}

/// Cells between the solid's bounds and the border of the grid.
constexpr int k_margin = 2;
// Relative to the size of the grid: covers rounding in centres and distances.
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

/// A box of blocks with its pruned tree.
struct Region {
  Eigen::Vector3i low;   ///< first block
  Eigen::Vector3i high;  ///< one past the last block
  std::vector<CsgNode> tree;

  [[nodiscard]] bool is_block() const { return (high - low).maxCoeff() == 1; }
  [[nodiscard]] Eigen::Vector3d centre() const { return 0.5 * k_block_cells * (low + high).cast<double>(); }
  /// Distance from the centre to the corners, in cells.
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

BoundedSolid bound_solid(const Model& model, const AlignedBox& bounds) {
  const AlignedBox own_bounds = bounds_of(model);
  Model field = bounded_field(model);
  BoundedSolid solid{std::move(*field.tree), std::move(field.primitives), own_bounds.intersection(bounds)};
  if (own_bounds.isEmpty() || solid.bounds.isEmpty()) return {};
  if (!is_finite(solid.bounds)) {
    throw Error({.where = "bounds",
                 .expected = "expected finite bounds for an unbounded solid",
                 .remedy = "intersect the solid with a box, or give bounds at which to cut it"});
  }
  if (!bounds.contains(own_bounds)) {
    // If the solid ends within `bounds`, keeps the cutter's face clear of the solid's.
    const AlignedBox cut = bounds.intersection(grown(solid.bounds, 0.1 * solid.bounds.sizes().maxCoeff()));
    solid.tree = intersect(solid.tree, CsgTree::leaf(static_cast<PrimitiveIndex>(solid.primitives.size())));
    solid.primitives.push_back({.id = {}, .shape = Box{.size = cut.sizes()}, .pose = {.position = cut.center()}});
  }
  return solid;
}

/// Recursive bisection of the grid. Parts wholly inside or outside are final; single blocks are kept.
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
  /// Siblings share a tree, so one batch a primitive evaluates all their centres.
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
