#include "io/step/tree_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::brep {
namespace {

/// How many times faster than one moves a primitive's value may change; none where that is not known.
std::optional<double> steepness(const Primitive& primitive) {
  if (std::holds_alternative<Expression>(primitive.shape)) return {};
  return primitive.displacement ? 1 + std::numbers::sqrt3 * primitive.displacement->frequency : 1.0;
}

std::optional<double> steepness(const CsgTree& tree, const PrimitiveSet& primitives) {
  double largest = 1;
  for (const PrimitiveIndex index : primitives_of(tree)) {
    const std::optional<double> one = steepness(primitives[index]);
    if (!one) return {};
    largest = std::max(largest, *one);
  }
  return largest;
}

/// A cell of the grid of its level.
struct Cell {
  std::array<std::uint16_t, 3> place;
};

class Sampler {
 public:
  Sampler(const CsgTree& tree, const PrimitiveSet& primitives, const AlignedBox& box, int levels, const RunContext& run)
      : field_(bounded_field(tree, primitives)),
        steepness_(steepness(tree, primitives)),
        box_(box),
        levels_(steepness_ ? levels : std::min(levels, k_most_levels_of_expressions)),
        run_(run) {}

  VolumeEstimate estimate() {
    std::vector<Cell> cells{{}};
    for (int level = 0; level < levels_; ++level) {
      if (steepness_) cells = undecided(cells, level);
      cells = split(cells);
    }
    const auto [hits, deviants] = judge(cells);
    // Two points a cell: their mean varies by a quarter of the square of their difference.
    const double cell_volume = volume_of_cells(levels_);
    return {.volume = whole_ + 0.5 * cell_volume * static_cast<double>(hits),
            .error = 0.5 * cell_volume * std::sqrt(static_cast<double>(deviants))};
  }

 private:
  static constexpr int k_most_levels_of_expressions = 6;
  static constexpr std::size_t k_chunk = 4096;

  struct Counts {
    std::size_t hits = 0;      ///< points inside
    std::size_t deviants = 0;  ///< cells of which one point is inside
  };

  [[nodiscard]] Eigen::Vector3d size_of_cells(int level) const { return box_.sizes() / std::exp2(level); }
  [[nodiscard]] double volume_of_cells(int level) const { return size_of_cells(level).prod(); }

  /// The cells whose middle is so near to the surface that it may pass through them; counts the others.
  std::vector<Cell> undecided(const std::vector<Cell>& cells, int level) {
    const Eigen::Vector3d size = size_of_cells(level);
    const double reach = *steepness_ * 0.5 * size.norm();
    std::vector<double> values(cells.size());
    for_each_chunk(cells.size(), [&](std::size_t first, std::size_t last) {
      Points middles;
      for (std::size_t i = first; i < last; ++i) {
        const Eigen::Vector3d place(cells[i].place[0], cells[i].place[1], cells[i].place[2]);
        middles.push_back(box_.min() + size.cwiseProduct(place + Eigen::Vector3d::Constant(0.5)));
      }
      const std::vector<double> found = implicit_value(field_.tree, field_.primitives, middles);
      std::copy(found.begin(), found.end(), values.begin() + static_cast<std::ptrdiff_t>(first));
    });
    std::vector<Cell> left;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (std::abs(values[i]) <= reach) {
        left.push_back(cells[i]);
      } else if (values[i] < 0) {
        ++inside;
      }
    }
    whole_ += volume_of_cells(level) * static_cast<double>(inside);
    return left;
  }

  static std::vector<Cell> split(const std::vector<Cell>& cells) {
    std::vector<Cell> parts;
    parts.reserve(8 * cells.size());
    for (const Cell& cell : cells) {
      for (unsigned corner = 0; corner < 8; ++corner) {
        Cell part = cell;
        for (unsigned axis = 0; axis < 3; ++axis) {
          part.place[axis] = static_cast<std::uint16_t>(2U * cell.place[axis] + ((corner >> axis) & 1U));
        }
        parts.push_back(part);
      }
    }
    return parts;
  }

  [[nodiscard]] Counts judge(const std::vector<Cell>& cells) const {
    const Eigen::Vector3d size = size_of_cells(levels_);
    std::vector<Counts> counts(cells.size() / k_chunk + 1);
    for_each_chunk(cells.size(), [&](std::size_t first, std::size_t last) {
      RandomStream random(k_seed, 0, first);
      Points points;
      for (std::size_t i = first; i < last; ++i) {
        const Eigen::Vector3d place(cells[i].place[0], cells[i].place[1], cells[i].place[2]);
        for (int repeat = 0; repeat < 2; ++repeat) {
          const double x = random.uniform();
          const double y = random.uniform();
          points.push_back(box_.min() + size.cwiseProduct(place + Eigen::Vector3d(x, y, random.uniform())));
        }
      }
      const std::vector<double> values = implicit_value(field_.tree, field_.primitives, points);
      Counts& own = counts[first / k_chunk];
      for (std::size_t i = 0; i < values.size(); i += 2) {
        const int inside = (values[i] < 0 ? 1 : 0) + (values[i + 1] < 0 ? 1 : 0);
        own.hits += static_cast<std::size_t>(inside);
        own.deviants += inside == 1 ? 1U : 0U;
      }
    });
    Counts all;
    for (const Counts& one : counts) {
      all.hits += one.hits;
      all.deviants += one.deviants;
    }
    return all;
  }

  template <typename Work>
  void for_each_chunk(std::size_t count, const Work& work) const {
    for_each_index((count + k_chunk - 1) / k_chunk, run_,
                   [&](std::size_t chunk) { work(chunk * k_chunk, std::min(count, (chunk + 1) * k_chunk)); });
  }

  /// Which points are drawn is no choice of the user's: the error says how much it matters.
  static constexpr std::uint64_t k_seed = 1;

  BoundedField field_;
  std::optional<double> steepness_;
  AlignedBox box_;
  int levels_;
  const RunContext& run_;
  double whole_ = 0;  ///< volume of the cells that are wholly inside
};

}  // namespace

BoundedField bounded_field(const CsgTree& tree, const PrimitiveSet& primitives) {
  BoundedField field{.tree = tree, .primitives = primitives};
  for (const PrimitiveIndex index : primitives_of(tree)) {
    if (!std::holds_alternative<Expression>(primitives[index].shape)) continue;
    const OrientedBox box = oriented_bounds(primitives[index]);
    field.primitives.push_back({.id = {}, .shape = Box{.size = 2 * box.half_size}, .pose = box.pose});
    const CsgTree boxed =
        intersect(CsgTree::leaf(index), CsgTree::leaf(static_cast<PrimitiveIndex>(field.primitives.size() - 1)));
    for (std::size_t node = field.tree.size(); node-- > 0;) {
      if (field.tree.nodes()[node] == CsgNode::leaf(index)) field.tree.replace(node, boxed.nodes());
    }
  }
  return field;
}

VolumeEstimate tree_volume(const CsgTree& tree, const PrimitiveSet& primitives, const AlignedBox& box, int levels,
                           const RunContext& run) {
  if (box.isEmpty() || box.sizes().minCoeff() <= 0) return {};
  return Sampler(tree, primitives, box, levels, run).estimate();
}

}  // namespace cloud2csg::brep
