#include "paper/merge/common_subtree.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "core/tree/conjunction.hpp"

namespace cloud2csg {
namespace {

using Operand = MergeCandidate::Operand;

/// An operand of the smaller tree that is found at a valid place of the larger one.
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

}  // namespace

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

}  // namespace cloud2csg
