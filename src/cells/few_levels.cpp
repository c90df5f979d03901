#include "cells/few_levels.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "cloud2csg/restrict.hpp"

namespace cloud2csg {
namespace {

/// What is united, and what is taken away from that.
struct Written {
  std::vector<CsgTree> united;
  std::vector<CsgTree> taken = {};
};

CsgTree tree_of(const Written& written) {
  const CsgTree united = unite_all(written.united);
  return written.taken.empty() ? united : subtract(united, unite_all(written.taken));
}

void append(std::vector<CsgTree>& list, std::vector<CsgTree> more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Tells at which cells trees hold.
class Cells {
 public:
  explicit Cells(const CellComplex& complex)
      : cells_(complex.cells),
        everywhere_(complex.points_of_primitive.size(), true),
        cells_of_(complex.points_of_primitive.size()) {
    for (CellIndex cell = 0; cell < cells_.size(); ++cell) {
      for (const PrimitiveIndex p : cells_[cell]) cells_of_[p].push_back(cell);
    }
  }

  [[nodiscard]] bool hold(const CsgTree& tree, const Cell& cell) const {
    const CsgNode root = tree.nodes().back();
    if (root.is_leaf()) return std::ranges::binary_search(cell, root.primitive());
    return contains(restrict_to(tree, cell), everywhere_);
  }

  /// Where it holds; none is outside of all its primitives.
  [[nodiscard]] std::vector<CellIndex> of(const CsgTree& tree) const {
    std::vector<CellIndex> cells;
    for (const PrimitiveIndex p : primitives_of(tree)) {
      cells.insert(cells.end(), cells_of_[p].begin(), cells_of_[p].end());
    }
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    std::erase_if(cells, [&](CellIndex cell) { return !hold(tree, cells_[cell]); });
    return cells;
  }

  [[nodiscard]] const Cell& operator[](CellIndex cell) const { return cells_[cell]; }

 private:
  const std::vector<Cell>& cells_;
  std::vector<bool> everywhere_;
  std::vector<std::vector<CellIndex>> cells_of_;  // by primitive
};

/// What is united, in groups that nothing which is taken away joins.
class Groups {
 public:
  Groups(const Written& written, const Cells& cells)
      : written_(written), cells_(cells), leader_(written.united.size()), group_of_taken_(written.taken.size(), 0) {
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    const auto is_everywhere = [&](const CsgTree& tree) { return cells.hold(tree, {}); };
    if (std::ranges::any_of(written.united, is_everywhere) || std::ranges::any_of(written.taken, is_everywhere)) {
      std::ranges::fill(leader_, 0);
      return;
    }
    for (std::size_t k = 0; k < written.united.size(); ++k) {
      for (const PrimitiveIndex p : primitives_of(written.united[k])) owners_.emplace_back(p, k);
    }
    std::ranges::sort(owners_);
    for (std::size_t t = 0; t < written.taken.size(); ++t) join_what_is_cut_by(t);
  }

  /// The groups, in the order of what is united.
  [[nodiscard]] std::vector<CsgTree> trees() {
    std::vector<Written> groups(written_.united.size());
    for (std::size_t k = 0; k < groups.size(); ++k) groups[leader_of(k)].united.push_back(written_.united[k]);
    for (std::size_t t = 0; t < group_of_taken_.size(); ++t) {
      groups[leader_of(group_of_taken_[t])].taken.push_back(written_.taken[t]);
    }
    std::vector<CsgTree> trees;
    for (const Written& group : groups) {
      if (group.taken.empty())
        append(trees, group.united);
      else
        trees.push_back(tree_of(group));
    }
    return trees;
  }

 private:
  void join_what_is_cut_by(std::size_t taken) {
    std::optional<std::size_t> first;
    for (const CellIndex index : cells_.of(written_.taken[taken])) {
      for (const PrimitiveIndex p : cells_[index]) {
        for (auto [at, end] = std::ranges::equal_range(owners_, p, {}, &Owner::first); at != end; ++at) {
          if (first && leader_of(at->second) == leader_of(*first)) continue;
          if (!cells_.hold(written_.united[at->second], cells_[index])) continue;
          if (first)
            join(*first, at->second);
          else
            first = at->second;
        }
      }
    }
    group_of_taken_[taken] = first.value_or(0);
  }

  /// The first of a group leads it.
  void join(std::size_t a, std::size_t b) {
    const auto [least, most] = std::minmax({leader_of(a), leader_of(b)});
    leader_[most] = least;
  }

  std::size_t leader_of(std::size_t k) {
    while (leader_[k] != k) k = leader_[k] = leader_[leader_[k]];
    return k;
  }

  using Owner = std::pair<PrimitiveIndex, std::size_t>;  // a primitive, and which of what is united has it

  const Written& written_;
  const Cells& cells_;
  std::vector<Owner> owners_;
  std::vector<std::size_t> leader_, group_of_taken_;
};

/// From the leaves up.
class Writer {
 public:
  explicit Writer(const CellComplex& complex) : cells_(complex) {}

  CsgTree write(const CsgTree& tree) {
    for (const CsgNode node : tree.nodes()) add(node);
    return alone(pop());
  }

 private:
  void add(CsgNode node) {
    switch (node.operation()) {
      case Operation::union_of: {
        std::vector<CsgTree> second = united(pop());
        std::vector<CsgTree> first = united(pop());
        append(first, std::move(second));
        stack_.push_back({std::move(first)});
        return;
      }
      case Operation::difference: {
        append_to_taken(united(pop()));
        return;
      }
      case Operation::intersection: {
        const CsgTree second = alone(pop());
        stack_.push_back({{intersect(alone(pop()), second)}});
        return;
      }
      case Operation::complement:
        stack_.push_back({{complement(alone(pop()))}});
        return;
      default:
        stack_.push_back({{CsgTree(std::vector{node})}});
    }
  }

  void append_to_taken(std::vector<CsgTree> more) { append(stack_.back().taken, std::move(more)); }

  Written pop() {
    Written top = std::move(stack_.back());
    stack_.pop_back();
    return top;
  }

  /// As operands of a union, where groups save a level each time.
  std::vector<CsgTree> united(Written written) {
    if (written.taken.empty()) return std::move(written.united);
    return Groups(written, cells_).trees();
  }

  /// By itself, where they need not.
  CsgTree alone(const Written& written) {
    const CsgTree outermost = tree_of(written);
    if (written.taken.empty()) return outermost;
    const CsgTree in_groups = unite_all(Groups(written, cells_).trees());
    return levels(in_groups) < levels(outermost) ? in_groups : outermost;
  }

  Cells cells_;
  std::vector<Written> stack_;
};

}  // namespace

CsgTree with_few_levels(const CsgTree& tree, const CellComplex& complex) {
  return Writer(complex).write(tree);
}

}  // namespace cloud2csg
