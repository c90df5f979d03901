#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <span>
#include <stop_token>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/tree/conjunction.hpp"

namespace cloud2csg {
namespace {

/// A tree indexed for the search for subtrees that it shares with others. Nodes other than unions are **operands**.
/// Each is in one **group**: its maximal union, possibly of one operand only. A subtree is one or more operands of a
/// group. A group is valid when its top is reached from the root through unions and first children of differences. All
/// its operands are then valid merge nodes.
struct MergeCandidate {
  struct Operand {
    std::uint64_t hash;  ///< structural_hash of the subtree
    std::uint32_t group;
    std::uint32_t node;
    std::uint32_t size;
  };
  CsgTree tree;
  std::vector<PrimitiveIndex> primitives;  ///< ascending
  std::vector<std::uint32_t> group_top;    ///< node index by group; groups are numbered from the root down
  std::vector<Operand> operands;           ///< all, from the root down
  std::vector<Operand> merge_nodes;        ///< operands of valid groups, by hash, then from the root down
};

/// A common subtree at a valid place in the larger of two trees.
struct CommonSubtree {
  std::size_t size;                  ///< nodes, with the unions of its operands
  std::uint32_t group;               ///< in the larger tree
  std::vector<std::uint32_t> nodes;  ///< roots of its operands in the larger tree, ascending
};

using Operand = MergeCandidate::Operand;

/// An operand of the smaller tree that is found at a valid place in the larger one.
struct Match {
  std::uint32_t smaller_group;
  std::uint32_t larger_group;
  std::uint32_t node;  ///< in the larger tree
  std::uint32_t size;

  [[nodiscard]] bool same_groups(const Match& other) const {
    return smaller_group == other.smaller_group && larger_group == other.larger_group;
  }
};

std::vector<Match> find_matches(const MergeCandidate& larger, const MergeCandidate& smaller) {
  std::vector<Match> matches;
  for (const Operand& operand : smaller.operands) {
    auto node = std::ranges::lower_bound(larger.merge_nodes, operand.hash, {}, &Operand::hash);
    for (; node != larger.merge_nodes.end() && node->hash == operand.hash; ++node) {
      matches.push_back({operand.group, node->group, node->node, node->size});
    }
  }
  std::ranges::sort(matches, {},
                    [](const Match& match) { return std::tuple(match.larger_group, match.smaller_group, match.node); });
  return matches;
}

/// O(size log size).
MergeCandidate make_merge_candidate(CsgTree tree) {
  MergeCandidate result{.tree = std::move(tree), .primitives = {}, .group_top = {}, .operands = {}, .merge_nodes = {}};
  const CsgTree& t = result.tree;
  result.primitives = primitives_of(t);
  const std::vector<std::uint64_t> hashes = structural_hashes(t);
  std::vector<std::uint32_t> group_of(t.size());
  std::vector<bool> is_valid;  // by group
  const auto start_group = [&](std::size_t top, bool valid) {
    group_of[top] = narrow(is_valid.size());
    result.group_top.push_back(narrow(top));
    is_valid.push_back(valid);
  };
  start_group(t.root(), true);
  for (std::size_t i = t.size(); i-- > 0;) {  // parents come before their children
    const CsgNode node = t.nodes()[i];
    const std::uint32_t group = group_of[i];
    if (node.operation() == Operation::union_of) {
      group_of[t.first_child(i)] = group;
      group_of[t.second_child(i)] = group;
      continue;
    }
    result.operands.push_back({.hash = hashes[i], .group = group, .node = narrow(i), .size = node.length()});
    if (is_valid[group]) result.merge_nodes.push_back(result.operands.back());
    const bool keeps_valid = node.operation() == Operation::difference && is_valid[group];
    if (arity(node.operation()) == 2) start_group(t.first_child(i), keeps_valid);
    if (arity(node.operation()) > 0) start_group(t.second_child(i), false);
  }
  std::ranges::stable_sort(result.merge_nodes, {}, &Operand::hash);
  return result;
}

/// The largest common subtree with a valid merge node in `larger`, on ties the nearest to the roots.
/// O(size of smaller x log size of larger).
std::optional<CommonSubtree> largest_common_subtree(const MergeCandidate& larger, const MergeCandidate& smaller) {
  const std::vector<Match> matches = find_matches(larger, smaller);
  std::span<const Match> best;
  std::size_t best_size = 0;
  for (std::size_t begin = 0, end = 0; begin < matches.size(); begin = end) {
    std::size_t size = 0;
    for (; end < matches.size() && matches[end].same_groups(matches[begin]); ++end) size += matches[end].size;
    size += end - begin - 1;  // the unions between the operands
    if (size <= best_size) continue;
    best_size = size;
    best = std::span(matches).subspan(begin, end - begin);
  }
  if (best.empty()) return std::nullopt;
  CommonSubtree common{.size = best_size, .group = best.front().larger_group, .nodes = {}};
  for (const Match& match : best) common.nodes.push_back(match.node);
  return common;
}

/// `larger` with `replacement` in place of the common subtree, not simplified. O(size).
CsgTree put_in_place(const MergeCandidate& larger, const CommonSubtree& common, const CsgTree& replacement) {
  std::vector<CsgNode> nodes;
  const auto unite_with = [&nodes](std::span<const CsgNode> more) {
    const bool is_first = nodes.empty();
    nodes.insert(nodes.end(), more.begin(), more.end());
    if (!is_first) nodes.push_back(CsgNode::inner(Operation::union_of, narrow(nodes.size() + 1)));
  };
  for (std::size_t i = larger.operands.size(); i-- > 0;) {  // from left to right
    const Operand& operand = larger.operands[i];
    if (operand.group != common.group) continue;
    if (operand.node == common.nodes.front()) {
      unite_with(replacement.nodes());
    } else if (!std::ranges::binary_search(common.nodes, operand.node)) {
      unite_with(larger.tree.subtree(operand.node));
    }
  }
  CsgTree result = larger.tree;
  result.replace(larger.group_top[common.group], nodes);
  return result;
}

bool share_a_primitive(const MergeCandidate& a, const MergeCandidate& b) {
  auto in_a = a.primitives.begin();
  auto in_b = b.primitives.begin();
  // Usually one is a partition's tree and the other has grown far beyond it.
  if (a.primitives.size() > 8 * b.primitives.size()) {
    return std::ranges::any_of(b.primitives, [&a](auto p) { return std::ranges::binary_search(a.primitives, p); });
  }
  while (in_a != a.primitives.end() && in_b != b.primitives.end()) {
    if (*in_a == *in_b) return true;
    *in_a < *in_b ? ++in_a : ++in_b;
  }
  return false;
}

/// Where two trees merge. The larger one receives the other; the first on ties.
struct MergePlan {
  const MergeCandidate& larger;
  const MergeCandidate& smaller;
  CommonSubtree common;
};

std::optional<MergePlan> plan_merge(const MergeCandidate& first, const MergeCandidate& second) {
  if (!share_a_primitive(first, second)) return std::nullopt;
  const bool second_is_larger = second.tree.size() > first.tree.size();
  const MergeCandidate& larger = second_is_larger ? second : first;
  const MergeCandidate& smaller = second_is_larger ? first : second;
  std::optional<CommonSubtree> common = largest_common_subtree(larger, smaller);
  if (!common) return std::nullopt;
  return MergePlan{larger, smaller, *std::move(common)};
}

MergeCandidate carry_out(const MergePlan& plan) {
  return make_merge_candidate(simplify(put_in_place(plan.larger, plan.common, plan.smaller.tree)));
}

std::vector<MergeCandidate> simplified_candidates(std::span<const CsgTree> trees) {
  std::vector<MergeCandidate> candidates;
  for (const CsgTree& tree : trees) {
    CsgTree simple = simplify(tree);
    if (simple != CsgTree::empty()) candidates.push_back(make_merge_candidate(std::move(simple)));
  }
  if (candidates.empty() && !trees.empty()) candidates.push_back(make_merge_candidate(CsgTree::empty()));
  return candidates;
}

/// Merges the tree at `head` with the first later one that it merges with.
bool merge_head(std::vector<MergeCandidate>& list, std::size_t head) {
  for (std::size_t next = head + 1; next < list.size(); ++next) {
    const std::optional<MergePlan> plan = plan_merge(list[head], list[next]);
    if (!plan) continue;
    list[head] = carry_out(*plan);
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(next));
    return true;
  }
  return false;
}

/// Returns the number of merges.
std::size_t merge_in_order_of_the_paper(std::vector<MergeCandidate>& list, const std::stop_token& stop) {
  std::size_t merges = 0;
  for (bool may_find_more = true; may_find_more;) {
    may_find_more = false;
    for (std::size_t head = 0; head < list.size(); ++head) {
      while (!stop.stop_requested() && merge_head(list, head)) {
        ++merges;
        may_find_more = may_find_more || head > 0;  // one of the trees passed over
      }
    }
  }
  return merges;
}

/// Removes the entries that `is_gone` and keeps the order of the others.
template <typename IsGone>
void drop_gone(std::vector<MergeCandidate>& list, const IsGone& is_gone) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!is_gone(i) && kept++ != i) list[kept - 1] = std::move(list[i]);
  }
  list.resize(kept);
}

/// A queue of mergeable pairs: the largest common subtree first, then the order of the list.
class LargestFirst {
 public:
  LargestFirst(std::vector<MergeCandidate>& slots, std::stop_token stop)
      : slots_(slots), versions_(slots.size(), 0), stop_(std::move(stop)) {}

  /// Returns the number of merges. Removes the slots of trees that went into others.
  std::size_t merge_all() {
    for (std::size_t i = 0; i < slots_.size() && !stop_.stop_requested(); ++i) {
      for (std::size_t j = i + 1; j < slots_.size(); ++j) consider(i, j);
    }
    std::size_t merges = 0;
    while (!pairs_.empty() && !stop_.stop_requested()) {
      const Pair pair = pairs_.top();
      pairs_.pop();
      if (versions_[pair.i] != pair.version_i || versions_[pair.j] != pair.version_j) continue;
      merge(pair);
      ++merges;
    }
    drop_gone(slots_, [this](std::size_t i) { return versions_[i] == k_gone; });
    return merges;
  }

 private:
  struct Pair {
    std::size_t common_size, i, j, version_i, version_j;
    bool operator<(const Pair& other) const {
      if (common_size != other.common_size) return common_size < other.common_size;
      return i != other.i ? i > other.i : j > other.j;
    }
  };
  static constexpr std::size_t k_gone = static_cast<std::size_t>(-1);

  void consider(std::size_t i, std::size_t j) {
    if (const auto plan = plan_merge(slots_[i], slots_[j])) {
      pairs_.push({plan->common.size, i, j, versions_[i], versions_[j]});
    }
  }

  /// Precondition: neither tree has changed since the pair was considered, so there is a plan.
  void merge(const Pair& pair) {
    slots_[pair.i] = carry_out(plan_merge(slots_[pair.i], slots_[pair.j]).value());
    ++versions_[pair.i];
    versions_[pair.j] = k_gone;
    for (std::size_t other = 0; other < slots_.size(); ++other) {
      if (other == pair.i || versions_[other] == k_gone) continue;
      consider(std::min(pair.i, other), std::max(pair.i, other));
    }
  }

  std::vector<MergeCandidate>& slots_;
  std::vector<std::size_t> versions_;  ///< by slot: raised when its tree changes
  std::priority_queue<Pair> pairs_;
  std::stop_token stop_;
};

/// Lists up to this length skip the pairing rounds.
constexpr std::size_t k_short_list = 64;

/// For long lists: each tree merges with the first later one that it merges with and that has not merged yet, so that
/// trees about double in each round. A tree that grew by one partition at a time would be copied once for each.
class PairingRounds {
 public:
  PairingRounds(std::vector<MergeCandidate>& list, std::stop_token stop) : list_(list), stop_(std::move(stop)) {}

  /// Merges until the list is short or nothing merges. Returns the number of merges.
  std::size_t merge() {
    std::size_t merges = 0;
    while (list_.size() > k_short_list && !stop_.stop_requested()) {
      const std::size_t merged = merge_pairs();
      if (merged == 0) break;
      merges += merged;
    }
    return merges;
  }

 private:
  std::size_t merge_pairs() {
    index_primitives();
    std::vector<bool> has_merged(list_.size(), false), is_gone(list_.size(), false);
    std::size_t merges = 0;
    for (std::size_t i = 0; i < list_.size() && !stop_.stop_requested(); ++i) {
      if (has_merged[i]) continue;
      for (const std::size_t j : later_neighbours(i)) {
        if (has_merged[j]) continue;
        const std::optional<MergePlan> plan = plan_merge(list_[i], list_[j]);
        if (!plan) continue;
        list_[i] = carry_out(*plan);
        has_merged[i] = has_merged[j] = is_gone[j] = true;
        ++merges;
        break;
      }
    }
    drop_gone(list_, [&is_gone](std::size_t i) { return is_gone[i]; });
    return merges;
  }

  void index_primitives() {
    trees_with_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i) {
      for (const PrimitiveIndex p : list_[i].primitives) trees_with_[p].push_back(i);
    }
  }

  /// Later trees that share a primitive with tree i, ascending.
  [[nodiscard]] std::vector<std::size_t> later_neighbours(std::size_t i) const {
    std::vector<std::size_t> later;
    for (const PrimitiveIndex p : list_[i].primitives) {
      const std::vector<std::size_t>& trees = trees_with_.at(p);
      later.insert(later.end(), std::ranges::upper_bound(trees, i), trees.end());
    }
    std::ranges::sort(later);
    later.erase(std::unique(later.begin(), later.end()), later.end());
    return later;
  }

  std::vector<MergeCandidate>& list_;
  std::unordered_map<PrimitiveIndex, std::vector<std::size_t>> trees_with_;  // as the round began
  std::stop_token stop_;
};

std::size_t blocked_pairs(std::span<const MergeCandidate> list) {
  std::size_t blocked = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t j = i + 1; j < list.size(); ++j) blocked += share_a_primitive(list[i], list[j]) ? 1 : 0;
  }
  return blocked;
}

}  // namespace

MergeResult merge_trees(std::span<const CsgTree> trees, MergeOrder order, const RunContext& run) {
  std::vector<MergeCandidate> list = simplified_candidates(trees);
  MergeResult result;
  result.merges = PairingRounds(list, run.stop).merge();
  result.merges += order == MergeOrder::paper ? merge_in_order_of_the_paper(list, run.stop)
                                              : LargestFirst(list, run.stop).merge_all();
  result.blocked = blocked_pairs(list);
  for (MergeCandidate& candidate : list) result.trees.push_back(std::move(candidate.tree));
  return result;
}

}  // namespace cloud2csg
