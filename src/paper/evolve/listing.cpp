#include "paper/evolve/listing.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <unordered_set>

namespace cloud2csg {
namespace {

using Column = AlignedVector<std::int8_t>;

/// How a candidate was made, and the rank that it selects in each class.
struct Candidate {
  Operation operation = Operation::primitive;
  std::uint32_t first = 0;  // index of a candidate; for a leaf, the primitive
  std::uint32_t second = 0;
  std::uint32_t size = 1;
  Column column = {};
};

struct Combination {
  Operation operation;
  bool swapped;
};
constexpr std::array k_combinations{
    Combination{Operation::union_of, false}, Combination{Operation::intersection, false},
    Combination{Operation::difference, false}, Combination{Operation::difference, true}};

std::uint64_t hash_of(const Column& column) {
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < column.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, column.data() + i, sizeof word);
    hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15ULL, 29);
  }
  return hash;
}

/// A tree on a subset of primitives joins one on a part with one on the rest. A bit of `subset` is a primitive.
class Lister {
 public:
  explicit Lister(const RankClasses& table) : table_(table), of_subset_(std::size_t{1} << table.primitive_count()) {}

  Listing run(const std::stop_token& stop) {
    for (std::uint32_t p = 0; p < table_.primitive_count(); ++p) add_leaf(p);
    // Each part of a subset is a smaller number, so it comes first.
    for (std::uint32_t subset = 1; subset < of_subset_.size() && !stop.stop_requested(); ++subset) {
      if (std::popcount(subset) > 1) list_subset(subset);
    }
    return {.best = {best_complemented_ ? complement(tree_of(best_)) : tree_of(best_), best_score_},
            .evaluations = evaluations_,
            .complete = !stop.stop_requested()};
  }

 private:
  void add_leaf(std::uint32_t p) {
    const std::span<const std::int8_t> column = table_.column(p);
    Candidate leaf{.first = p, .column = Column(column.begin(), column.end())};
    consider(leaf, candidates_.size());
    of_subset_[std::size_t{1} << p].push_back(static_cast<std::uint32_t>(candidates_.size()));
    candidates_.push_back(std::move(leaf));
  }

  void list_subset(std::uint32_t subset) {
    std::unordered_set<std::uint64_t> seen;
    // Each split comes once: the first part has the lowest primitive.
    const std::uint32_t lowest = subset & (~subset + 1);
    for (std::uint32_t part = (subset - 1) & subset; part > 0; part = (part - 1) & subset) {
      if ((part & lowest) == 0) continue;
      for (std::size_t a = 0; a < of_subset_[part].size(); ++a) {
        for (std::size_t b = 0; b < of_subset_[subset ^ part].size(); ++b) {
          join(subset, of_subset_[part][a], of_subset_[subset ^ part][b], seen);
        }
      }
    }
  }

  void join(std::uint32_t subset, std::uint32_t a, std::uint32_t b, std::unordered_set<std::uint64_t>& seen) {
    for (const Combination& how : k_combinations) {
      const std::uint32_t first = how.swapped ? b : a;
      const std::uint32_t second = how.swapped ? a : b;
      Candidate joined{.operation = how.operation,
                       .first = first,
                       .second = second,
                       .size = candidates_[first].size + candidates_[second].size + 1,
                       .column = Column(table_.padded_count())};
      RankClasses::combine(how.operation, candidates_[first].column, candidates_[second].column, joined.column);
      // All trees on a subset have the same size, so the first of equal ones will do.
      if (!seen.insert(hash_of(joined.column)).second) continue;
      consider(joined, candidates_.size());
      of_subset_[subset].push_back(static_cast<std::uint32_t>(candidates_.size()));
      candidates_.push_back(std::move(joined));
    }
  }

  void consider(const Candidate& candidate, std::size_t index) {
    const RankClasses::ColumnGeometry geometry = table_.column_geometry(candidate.column);
    const double alpha = table_.objective().alpha;
    evaluations_ += 2;
    take_if_better(geometry.of_column - alpha * candidate.size, index, false);
    take_if_better(geometry.of_negation - alpha * (candidate.size + 1), index, true);
  }

  void take_if_better(double score, std::size_t index, bool complemented) {
    if (score <= best_score_) return;
    best_score_ = score;
    best_ = static_cast<std::uint32_t>(index);
    best_complemented_ = complemented;
  }

  [[nodiscard]] CsgTree tree_of(std::uint32_t index) const {
    const Candidate& candidate = candidates_[index];
    switch (candidate.operation) {
      case Operation::primitive:
        return CsgTree::leaf(candidate.first);
      case Operation::union_of:
        return unite(tree_of(candidate.first), tree_of(candidate.second));
      case Operation::intersection:
        return intersect(tree_of(candidate.first), tree_of(candidate.second));
      default:
        return subtract(tree_of(candidate.first), tree_of(candidate.second));
    }
  }

  const RankClasses& table_;
  std::vector<std::vector<std::uint32_t>> of_subset_;
  std::vector<Candidate> candidates_;
  double best_score_ = -std::numeric_limits<double>::infinity();
  std::uint32_t best_ = 0;
  bool best_complemented_ = false;
  std::size_t evaluations_ = 0;
};

}  // namespace

Listing list_trees(const RankClasses& table, const std::stop_token& stop) {
  return Lister(table).run(stop);
}

}  // namespace cloud2csg
