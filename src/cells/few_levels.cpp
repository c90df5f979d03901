#include "cells/few_levels.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace cloud2csg {
namespace {

/// United trees, and the trees taken away from their union.
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

/// Which primitives share a cell. Two trees that hold only within their primitives overlap only where a primitive of
/// one shares a cell with one of the other. A cell of many primitives that was not found does not change that.
class Neighbours {
 public:
  explicit Neighbours(const CellComplex& complex)
      : nowhere_(complex.points_of_primitive.size(), false), of_(complex.points_of_primitive.size()) {
    for (const Cell& cell : complex.cells) {
      for (const PrimitiveIndex p : cell) of_[p].insert(of_[p].end(), cell.begin(), cell.end());
    }
    for (std::vector<PrimitiveIndex>& neighbours : of_) sort_unique(neighbours);
  }

  /// All primitives that share a cell with one of the tree's, ascending.
  [[nodiscard]] std::vector<PrimitiveIndex> of(const CsgTree& tree) const {
    std::vector<PrimitiveIndex> all;
    for (const PrimitiveIndex p : primitives_of(tree)) all.insert(all.end(), of_[p].begin(), of_[p].end());
    sort_unique(all);
    return all;
  }

  [[nodiscard]] bool is_within_its_primitives(const CsgTree& tree) const { return !contains(tree, nowhere_); }

 private:
  static void sort_unique(std::vector<PrimitiveIndex>& primitives) {
    std::ranges::sort(primitives);
    primitives.erase(std::unique(primitives.begin(), primitives.end()), primitives.end());
  }

  std::vector<bool> nowhere_;
  std::vector<std::vector<PrimitiveIndex>> of_;  // by primitive
};

/// The united trees in groups, such that no taken tree cuts two groups.
class Groups {
 public:
  Groups(const Written& written, const Neighbours& neighbours)
      : written_(written),
        neighbours_(neighbours),
        leader_(written.united.size()),
        group_of_taken_(written.taken.size(), 0) {
    std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    const auto is_bounded = [&](const CsgTree& tree) { return neighbours.is_within_its_primitives(tree); };
    if (!std::ranges::all_of(written.united, is_bounded) || !std::ranges::all_of(written.taken, is_bounded)) {
      std::ranges::fill(leader_, 0);
      return;
    }
    for (std::size_t k = 0; k < written.united.size(); ++k) {
      for (const PrimitiveIndex p : primitives_of(written.united[k])) owners_.emplace_back(p, k);
    }
    std::ranges::sort(owners_);
    for (std::size_t t = 0; t < written.taken.size(); ++t) join_what_is_cut_by(t);
  }

  /// Trees of the groups, in the order of the united ones.
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
    for (const PrimitiveIndex p : neighbours_.of(written_.taken[taken])) {
      for (auto owner = std::ranges::lower_bound(owners_, Owner{p, 0}); owner != owners_.end() && owner->first == p;
           ++owner) {
        if (!first) first = owner->second;
        join(*first, owner->second);
      }
    }
    group_of_taken_[taken] = first.value_or(0);
  }

  void join(std::size_t a, std::size_t b) {
    const auto [least, most] = std::minmax({leader_of(a), leader_of(b)});
    leader_[most] = least;
  }

  std::size_t leader_of(std::size_t k) {
    while (leader_[k] != k) k = leader_[k] = leader_[leader_[k]];
    return k;
  }

  using Owner = std::pair<PrimitiveIndex, std::size_t>;  // a primitive, and the place of a united tree that has it

  const Written& written_;
  const Neighbours& neighbours_;
  std::vector<Owner> owners_;
  std::vector<std::size_t> leader_, group_of_taken_;
};

class Writer {
 public:
  explicit Writer(const CellComplex& complex) : neighbours_(complex) {}

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
    return Groups(written, neighbours_).trees();
  }

  /// As a tree by itself, where groups may save no level.
  CsgTree alone(const Written& written) {
    CsgTree outermost = tree_of(written);
    if (written.taken.empty()) return outermost;
    CsgTree in_groups = unite_all(Groups(written, neighbours_).trees());
    return levels(in_groups) < levels(outermost) ? in_groups : outermost;
  }

  Neighbours neighbours_;
  std::vector<Written> stack_;
};

}  // namespace

CsgTree with_few_levels(const CsgTree& tree, const CellComplex& complex) {
  return Writer(complex).write(tree);
}

}  // namespace cloud2csg
