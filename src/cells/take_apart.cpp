#include "cells/take_apart.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "cells/cell_hash.hpp"
#include "cloud2csg/advanced/cells.hpp"
#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {
namespace {

Cell without(const Cell& cell, PrimitiveIndex primitive) {
  Cell rest = cell;
  std::erase(rest, primitive);
  return rest;
}

/// Primitives by the points on patches between a cell that they hold and one that they do not, fewest first.
std::vector<PrimitiveIndex> least_seen_first(const CellComplex& complex) {
  std::vector<double> seen(complex.points_of_primitive.size());
  Cell between;
  for (const Patch& patch : complex.patches) {
    between.clear();
    std::ranges::set_symmetric_difference(complex.cells[patch.first], complex.cells[patch.second],
                                          std::back_inserter(between));
    for (const PrimitiveIndex p : between) seen[p] += patch.first_in + patch.second_in;
  }
  std::vector<PrimitiveIndex> order(seen.size());
  std::iota(order.begin(), order.end(), PrimitiveIndex{0});
  std::ranges::stable_sort(order, {}, [&seen](PrimitiveIndex p) { return seen[p]; });
  return order;
}

struct KnownCell {
  Cell cell;
  bool is_in = false;
  bool is_open = true;  ///< no peeled primitive decides it
};

/// The sure cells and the outside cell, without primitives that no label depends on. Inverts all labels where the
/// outside cell is in the solid.
class KnownCells {
 public:
  KnownCells(const KnownCells&) = delete;
  KnownCells& operator=(const KnownCells&) = delete;
  KnownCells(KnownCells&&) = delete;
  KnownCells& operator=(KnownCells&&) = delete;

  /// O(size of all cells)
  KnownCells(const CellComplex& complex, const CellLabels& labels, double least_evidence)
      : cells_of_(complex.points_of_primitive.size()), index_(complex.cells.size(), Hash{this}, Equal{this}) {
    for (CellIndex c = 0; c < complex.cells.size(); ++c) {
      // The outside cell keeps its label in any case: the rest is split off from it.
      if (c > 0 && labels.evidence[c] < least_evidence) continue;
      for (const PrimitiveIndex p : complex.cells[c]) cells_of_[p].push_back(cells_.size());
      cells_.push_back({complex.cells[c], labels.is_in[c] != labels.is_in.front()});
    }
    for (std::size_t c = 0; c < cells_.size(); ++c) index_.insert(c);
    std::vector<bool> is_essential(cells_of_.size());
    for (PrimitiveIndex p = 0; p < cells_of_.size(); ++p) is_essential[p] = is_needed(p);
    essential_ = static_cast<std::size_t>(std::ranges::count(is_essential, true));
    // Essential primitives stay so, whatever else is left out.
    for (const PrimitiveIndex p : least_seen_first(complex)) {
      if (!is_essential[p] && !is_needed(p)) leave_out(p);
    }
  }

  /// Leaves the object without cells.
  [[nodiscard]] std::vector<KnownCell> take_sorted() {
    std::erase_if(cells_, [](const KnownCell& known) { return !known.is_open; });
    std::ranges::sort(cells_, {}, &KnownCell::cell);
    return std::move(cells_);
  }

  /// How many primitives any tree needs, if the outside cell is sure.
  [[nodiscard]] std::size_t essential() const { return essential_; }
  /// Whether all primitives with cells are essential.
  [[nodiscard]] bool are_all_essential() const { return left_out_ == 0; }

 private:
  /// The index holds places in cells_ and is searched for cells.
  struct Hash {
    using is_transparent = void;
    const KnownCells* known;
    std::size_t operator()(std::size_t place) const { return CellHash()(known->cells_[place].cell); }
    std::size_t operator()(const Cell& cell) const { return CellHash()(cell); }
  };
  struct Equal {
    using is_transparent = void;
    const KnownCells* known;
    bool operator()(std::size_t a, std::size_t b) const { return known->cells_[a].cell == known->cells_[b].cell; }
    bool operator()(std::size_t place, const Cell& cell) const { return known->cells_[place].cell == cell; }
    bool operator()(const Cell& cell, std::size_t place) const { return known->cells_[place].cell == cell; }
  };

  /// Whether two cells differ only in the primitive and in their labels.
  [[nodiscard]] bool is_needed(PrimitiveIndex p) const {
    return std::ranges::any_of(cells_of_[p], [&](std::size_t c) {
      if (!cells_[c].is_open) return false;
      const auto other = index_.find(without(cells_[c].cell, p));
      return other != index_.end() && cells_[*other].is_in != cells_[c].is_in;
    });
  }

  void leave_out(PrimitiveIndex p) {
    left_out_ += cells_of_[p].empty() ? 0 : 1;
    for (const std::size_t c : cells_of_[p]) {
      if (!cells_[c].is_open) continue;
      index_.erase(index_.find(c));
      std::erase(cells_[c].cell, p);
      // Not open if it has become equal to another cell.
      cells_[c].is_open = index_.insert(c).second;
    }
  }

  std::vector<KnownCell> cells_;
  std::vector<std::vector<std::size_t>> cells_of_;  // by primitive
  std::unordered_set<std::size_t, Hash, Equal> index_;
  std::size_t essential_ = 0, left_out_ = 0;
};

/// Splits off primitives that are wholly in or wholly out.
class Peeler {
 public:
  Peeler(std::vector<KnownCell> cells, std::size_t primitives)
      : cells_(std::move(cells)), cells_of_(primitives), in_(primitives), out_(primitives) {
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      for (const PrimitiveIndex p : cells_[c].cell) {
        cells_of_[p].push_back(c);
        ++(cells_[c].is_in ? in_ : out_)[p];
      }
    }
  }

  /// The first round stands outermost. Starts with differences.
  [[nodiscard]] std::vector<PeeledRound> peel() {
    std::vector<PeeledRound> rounds;
    bool are_in = false;
    for (int idle = 0; idle < 2; are_in = !are_in) {
      PeeledRound round{.are_in = are_in, .primitives = {}};
      for (const PrimitiveIndex p : candidates(are_in)) {
        // Not needed if all of its cells have been decided meanwhile.
        if ((are_in ? in_ : out_)[p] == 0) continue;
        round.primitives.push_back(p);
        close_cells_of(p);
      }
      std::ranges::sort(round.primitives);
      idle = round.primitives.empty() ? idle + 1 : 0;
      if (!round.primitives.empty()) rounds.push_back(std::move(round));
    }
    return rounds;
  }

  [[nodiscard]] const std::vector<KnownCell>& cells() const { return cells_; }

 private:
  /// Primitives with the most cells first, since they may decide the cells of others.
  [[nodiscard]] std::vector<PrimitiveIndex> candidates(bool are_in) const {
    const std::vector<std::size_t>& right = are_in ? in_ : out_;
    const std::vector<std::size_t>& wrong = are_in ? out_ : in_;
    std::vector<PrimitiveIndex> found;
    for (PrimitiveIndex p = 0; p < cells_of_.size(); ++p) {
      if (right[p] > 0 && wrong[p] == 0) found.push_back(p);
    }
    std::ranges::stable_sort(found, std::greater<>(), [&right](PrimitiveIndex p) { return right[p]; });
    return found;
  }

  void close_cells_of(PrimitiveIndex p) {
    for (const std::size_t c : cells_of_[p]) {
      KnownCell& known = cells_[c];
      if (!known.is_open) continue;
      known.is_open = false;
      for (const PrimitiveIndex other : known.cell) --(known.is_in ? in_ : out_)[other];
    }
  }

  std::vector<KnownCell> cells_;
  std::vector<std::vector<std::size_t>> cells_of_;  // by primitive
  std::vector<std::size_t> in_, out_;               // by primitive: open cells with it
};

Assignment assignment_of(const Cell& cell, std::span<const PrimitiveIndex> primitives) {
  Assignment row = 0;
  for (std::size_t place = 0; place < primitives.size(); ++place) {
    if (std::ranges::binary_search(cell, primitives[place])) row |= Assignment{1} << place;
  }
  return row;
}

/// Finds the cores of the open cells.
class CoreFinder {
 public:
  CoreFinder(const std::vector<KnownCell>& cells, std::size_t primitives) : cells_(cells), leader_(primitives) {
    std::iota(leader_.begin(), leader_.end(), PrimitiveIndex{0});
    for_each_open([this](const KnownCell& known) {
      for (const PrimitiveIndex p : known.cell) leader_[leader_of(p)] = leader_of(known.cell.front());
    });
  }

  /// Ascending by their first primitives. Cores of too many primitives have no rows.
  [[nodiscard]] std::vector<Core> cores() {
    std::vector<bool> is_used(leader_.size(), false);
    for_each_open([&](const KnownCell& known) {
      for (const PrimitiveIndex p : known.cell) is_used[p] = true;
    });
    std::vector<Core> cores;
    std::unordered_map<PrimitiveIndex, std::size_t> place;
    for (PrimitiveIndex p = 0; p < leader_.size(); ++p) {
      if (!is_used[p]) continue;
      const auto [found, is_new] = place.try_emplace(leader_of(p), cores.size());
      if (is_new) cores.push_back({.primitives = {}, .rows = {.on = {}, .off = {0}}});
      cores[found->second].primitives.push_back(p);
    }
    for_each_open([&](const KnownCell& known) {
      Core& core = cores[place.at(leader_of(known.cell.front()))];
      if (core.primitives.size() > k_most_variables) return;
      (known.is_in ? core.rows.on : core.rows.off).push_back(assignment_of(known.cell, core.primitives));
    });
    return cores;
  }

 private:
  template <class Visit>
  void for_each_open(const Visit& visit) const {
    for (const KnownCell& known : cells_) {
      if (known.is_open && !known.cell.empty()) visit(known);
    }
  }

  PrimitiveIndex leader_of(PrimitiveIndex p) {
    while (leader_[p] != p) p = leader_[p] = leader_[leader_[p]];
    return p;
  }

  const std::vector<KnownCell>& cells_;
  std::vector<PrimitiveIndex> leader_;
};

bool is_too_large(const Core& core) {
  return core.primitives.size() > k_most_variables;
}

std::vector<CsgTree> leaves(const std::vector<PrimitiveIndex>& primitives) {
  std::vector<CsgTree> trees;
  trees.reserve(primitives.size());
  for (const PrimitiveIndex p : primitives) trees.push_back(CsgTree::leaf(p));
  return trees;
}

}  // namespace

std::optional<TakenApart> take_apart(const CellComplex& complex, const CellLabels& labels, double least_evidence) {
  const std::size_t primitives = complex.points_of_primitive.size();
  KnownCells known(complex, labels, least_evidence);
  TakenApart parts{.is_inverted = labels.is_in.front(),
                   .essential = known.essential(),
                   .are_all_essential = known.are_all_essential(),
                   .is_outside_sure = labels.evidence.front() >= least_evidence};
  Peeler peeler(known.take_sorted(), primitives);
  parts.rounds = peeler.peel();
  parts.cores = CoreFinder(peeler.cells(), primitives).cores();
  if (std::ranges::any_of(parts.cores, is_too_large)) return std::nullopt;
  return parts;
}

std::optional<TakenApart> take_apart_only(const CellComplex& complex, const CellLabels& labels, double least_evidence) {
  std::vector<KnownCell> known;
  for (CellIndex c = 0; c < complex.cells.size(); ++c) {
    if (labels.evidence[c] < least_evidence) continue;
    known.push_back({complex.cells[c], labels.is_in[c] != labels.is_in.front()});
  }
  TakenApart parts{.is_inverted = labels.is_in.front(),
                   .cores = CoreFinder(known, complex.points_of_primitive.size()).cores(),
                   .is_outside_sure = labels.evidence.front() >= least_evidence};
  if (std::ranges::any_of(parts.cores, is_too_large)) return std::nullopt;
  return parts;
}

CsgTree put_together(const TakenApart& parts, std::span<const CsgTree> of_cores) {
  CsgTree tree = unite_all(of_cores);
  std::for_each(parts.rounds.rbegin(), parts.rounds.rend(), [&tree](const PeeledRound& round) {
    const CsgTree split = unite_all(leaves(round.primitives));
    tree = round.are_in ? unite(tree, split) : subtract(tree, split);
  });
  return simplify(parts.is_inverted ? complement(tree) : tree);
}

}  // namespace cloud2csg
