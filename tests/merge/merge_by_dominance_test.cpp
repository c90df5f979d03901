#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstddef>
#include <stop_token>
#include <string>
#include <vector>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

/// Whether every two of the primitives of the mask overlap: there is a place inside of exactly these, at most.
bool is_clique(const OverlapGraph& graph, unsigned mask) {
  for (PrimitiveIndex a = 0; a < graph.size(); ++a) {
    for (PrimitiveIndex b = a + 1; b < graph.size(); ++b) {
      if ((mask >> a & 1U) != 0 && (mask >> b & 1U) != 0 && !graph.has_edge(a, b)) return false;
    }
  }
  return true;
}

OverlapGraph random_graph(std::size_t primitives, double density, RandomStream& random) {
  OverlapGraph graph{.neighbours = std::vector<std::vector<PrimitiveIndex>>(primitives)};
  for (PrimitiveIndex a = 0; a < primitives; ++a) {
    for (PrimitiveIndex b = a + 1; b < primitives; ++b) {
      if (!random.chance(density)) continue;
      graph.neighbours[a].push_back(b);
      graph.neighbours[b].push_back(a);
    }
  }
  return graph;
}

/// What the partitions' trees are when each tells the truth.
std::vector<CsgTree> trees_of(const std::vector<Clique>& cliques, const CsgTree& truth) {
  std::vector<CsgTree> trees;
  for (const Clique& clique : cliques) trees.push_back(restrict_to(truth, clique));
  return trees;
}

/// Whether both contain the same of space, wherever in whichever primitives that overlap.
bool agree(const CsgTree& a, const CsgTree& b, const OverlapGraph& graph) {
  const std::vector<bool> table_a = test::truth_table(a, graph.size());
  const std::vector<bool> table_b = test::truth_table(b, graph.size());
  for (unsigned mask = 0; mask < table_a.size(); ++mask) {
    if (table_a[mask] != table_b[mask] && is_clique(graph, mask)) return false;
  }
  return true;
}

/// Adds or removes each primitive once, in any order.
CsgTree random_layers(std::size_t primitives, RandomStream& random) {
  std::vector<PrimitiveIndex> order(primitives);
  for (PrimitiveIndex p = 0; p < primitives; ++p) {
    order[p] = p;
    std::swap(order[p], order[random.below(p + std::size_t{1})]);
  }
  CsgTree tree = CsgTree::leaf(order[0]);
  for (std::size_t k = 1; k < primitives; ++k) {
    const CsgTree next = CsgTree::leaf(order[k]);
    tree = random.chance(0.5) ? unite(tree, next) : subtract(tree, next);
  }
  return tree;
}

std::vector<PrimitiveIndex> primitives_of_all(const std::vector<CsgTree>& trees) {
  std::vector<PrimitiveIndex> all;
  for (const CsgTree& tree : trees) {
    const std::vector<PrimitiveIndex> some = primitives_of(simplify(tree));
    all.insert(all.end(), some.begin(), some.end());
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

struct LayeredCase {
  OverlapGraph graph;
  CsgTree truth;
  std::vector<Clique> cliques;
  std::vector<CsgTree> trees;
};

LayeredCase random_layered_case(std::uint64_t seed) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(10);
  LayeredCase result{.graph = random_graph(primitives, random.uniform(0.1, 0.9), random),
                     .truth = random_layers(primitives, random),
                     .cliques = {},
                     .trees = {}};
  result.cliques = maximal_cliques(result.graph);
  result.trees = trees_of(result.cliques, result.truth);
  return result;
}

RC_GTEST_PROP(MergeByDominance, RecoversWhatIsAddedAndRemovedInLayers, (std::uint64_t seed)) {
  const LayeredCase layered = random_layered_case(seed);
  const MergeResult merged = merge_by_dominance(layered.trees, layered.cliques);
  RC_ASSERT(merged.trees.size() == 1U);
  RC_ASSERT(merged.blocked == 0U);
  const CsgTree& tree = merged.trees.front();
  RC_ASSERT(test::is_well_formed(tree));
  RC_ASSERT(agree(tree, layered.truth, layered.graph));
}

RC_GTEST_PROP(MergeByDominance, NamesEachPrimitiveOfLayersOnce, (std::uint64_t seed)) {
  const LayeredCase layered = random_layered_case(seed);
  const CsgTree tree = merge_by_dominance(layered.trees, layered.cliques).trees.front();
  const std::vector<PrimitiveIndex> expected = primitives_of_all(layered.trees);
  RC_ASSERT(primitives_of(tree) == expected);
  RC_ASSERT(tree.size() == (expected.empty() ? 1 : 2 * expected.size() - 1));
  RC_ASSERT(simplify(tree) == tree);
}

RC_GTEST_PROP(MergeByDominance, TakesTreesInAnyOrder, (std::uint64_t seed)) {
  LayeredCase layered = random_layered_case(seed);
  const MergeResult expected = merge_by_dominance(layered.trees, layered.cliques);
  RC_ASSERT(merge_by_dominance(layered.trees, layered.cliques).trees == expected.trees);
  RandomStream random(seed, 1);
  for (std::size_t k = layered.trees.size(); k > 1; --k) {
    const std::size_t other = random.below(k);
    std::swap(layered.trees[k - 1], layered.trees[other]);
    std::swap(layered.cliques[k - 1], layered.cliques[other]);
  }
  const MergeResult shuffled = merge_by_dominance(layered.trees, layered.cliques);
  RC_ASSERT(shuffled.trees == expected.trees);
  RC_ASSERT(shuffled.merges == expected.merges);
}

/// Unites the intersections of p0 and p1, p2 and p3..., and adds or removes each further primitive once.
CsgTree random_layers_over_intersections(std::size_t pairs, std::size_t primitives, RandomStream& random) {
  CsgTree tree;
  for (PrimitiveIndex pair = 0; pair < pairs; ++pair) {
    tree = unite(tree, intersect(CsgTree::leaf(2 * pair), CsgTree::leaf(2 * pair + 1)));
  }
  for (auto p = static_cast<PrimitiveIndex>(2 * pairs); p < primitives; ++p) {
    tree = random.chance(0.5) ? unite(tree, CsgTree::leaf(p)) : subtract(tree, CsgTree::leaf(p));
  }
  return tree;
}

RC_GTEST_PROP(MergeByDominance, RecoversLayersOverIntersections, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t pairs = 1 + random.below(3);
  const std::size_t primitives = 2 * pairs + random.below(5);
  const OverlapGraph graph = random_graph(primitives, random.uniform(0.1, 0.9), random);
  const CsgTree truth = random_layers_over_intersections(pairs, primitives, random);
  const std::vector<Clique> cliques = maximal_cliques(graph);
  const MergeResult merged = merge_by_dominance(trees_of(cliques, truth), cliques);
  RC_ASSERT(merged.blocked == 0U);
  RC_ASSERT(merged.trees.size() == 1U);
  RC_ASSERT(agree(merged.trees.front(), truth, graph));
  RC_ASSERT(leaf_count(merged.trees.front()) == primitives_of(merged.trees.front()).size());
}

/// Where all overlap there is nothing to merge, but what is taken out is put back in its place.
RC_GTEST_PROP(MergeByDominance, LeavesASingleTreeOfAnyShapeTheSolidThatItIs, (const CsgTree& any)) {
  const CsgTree truth = restrict_to(any, {}) == CsgTree::empty() ? any : complement(any);  // bounded
  const std::vector<Clique> cliques{{0, 1, 2, 3, 4, 5}};
  const MergeResult merged = merge_by_dominance(std::vector{truth}, cliques);
  RC_ASSERT(merged.trees.size() == 1U);
  RC_ASSERT(test::truth_table(merged.trees.front(), 6) == test::truth_table(truth, 6));
}

/// Trees that tell anything, also what cannot be at once.
RC_GTEST_PROP(MergeByDominance, GivesSimpleTreesOverThePrimitivesThatWereGiven, (const std::vector<CsgTree>& trees)) {
  std::vector<Clique> cliques;
  for (const CsgTree& tree : trees) cliques.push_back(primitives_of(tree));
  const MergeResult merged = merge_by_dominance(trees, cliques);
  RC_ASSERT(!merged.trees.empty());
  RC_ASSERT(merged.blocked > 0U || merged.trees.size() == 1U);
  const std::vector<PrimitiveIndex> given = primitives_of_all(trees);
  for (const CsgTree& tree : merged.trees) {
    RC_ASSERT(test::is_well_formed(tree));
    RC_ASSERT(simplify(tree) == tree);
    RC_ASSERT(std::ranges::includes(given, primitives_of(tree)));
  }
}

/// A tree, and ids of primitives of its clique that it leaves out.
struct Partition {
  std::string tree;
  std::string left_out = {};
};

MergeResult result_of(const std::vector<Partition>& partitions, const RunContext& run = {}) {
  std::vector<CsgTree> trees;
  std::vector<Clique> cliques;
  for (const Partition& partition : partitions) {
    trees.push_back(parse_tree(partition.tree, test::letters()));
    cliques.push_back(primitives_of(trees.back()));
    for (const char id : partition.left_out) cliques.back().push_back(static_cast<PrimitiveIndex>(id - 'a'));
    std::ranges::sort(cliques.back());
  }
  return merge_by_dominance(trees, cliques, run);
}

std::vector<std::string> merged(const std::vector<Partition>& partitions) {
  std::vector<std::string> result;
  for (const CsgTree& tree : result_of(partitions).trees) result.push_back(to_text(tree, test::letters()));
  return result;
}

using Texts = std::vector<std::string>;

TEST(MergeByDominance, OfNothingIsNothing) {
  EXPECT_EQ(merge_by_dominance({}, {}).trees, std::vector{CsgTree::empty()});
  EXPECT_EQ(merged({{"empty"}, {"a - a"}}), Texts{"empty"});
}

TEST(MergeByDominance, LeavesOneAlone) {
  for (const char* text : {"a", "a - b", "(a | b) - c", "a & b", "(a & b) - c", "((a & b) | c) - d"}) {
    EXPECT_EQ(merged({{text}}), Texts{text});
  }
}

TEST(MergeByDominance, CutsWhereThePapersMergeCannot) {
  // Two blocks with the same bore: the paper has no valid node for b.
  EXPECT_EQ(merged({{"a - b"}, {"c - b"}}), Texts{"(a | c) - b"});
  // A knob on a bored plate that does not reach the bore; a plug in the bore of another.
  EXPECT_EQ(merged({{"a - b"}, {"a | c"}}), Texts{"(a | c) - b"});
  EXPECT_EQ(merged({{"(a - b) | c"}, {"a - d"}}), Texts{"((a - b) | c) - d"});
}

/// A bore that is cut into one solid only: the other, which it reaches, fills it again.
TEST(MergeByDominance, KeepsWhatLeavesAPrimitiveOutApart) {
  EXPECT_EQ(merged({{"a - b"}, {"c", "b"}}), Texts{"(a - b) | c"});
  EXPECT_EQ(merged({{"c", "b"}, {"a - b"}}), Texts{"(a - b) | c"});
  EXPECT_EQ(merged({{"a - b"}, {"c", "b"}, {"c - d"}}), Texts{"((a - b) | c) - d"});
}

TEST(MergeByDominance, LeavesWhatOverlapsToThePapersMerge) {
  EXPECT_EQ(merged({{"(a & b) | c"}, {"c | e"}}), Texts{"(a & b) | c | e"});
  EXPECT_EQ(merged({{"(a & b) - d"}, {"c - d"}}), Texts{"((a & b) | c) - d"});
  EXPECT_EQ(merged({{"(a & b) | (c & d)"}, {"(c & d) | e"}}), Texts{"(a & b) | (c & d) | e"});
}

TEST(MergeByDominance, TellsOfWhatIsBlocked) {
  const MergeResult result = result_of({{"(a & b) - d"}, {"(b & c) | e"}});
  EXPECT_EQ(result.blocked, 1U);
  EXPECT_EQ(result.trees.size(), 1U);
}

TEST(MergeByDominance, CopesWithContradictions) {
  EXPECT_EQ(merged({{"a - b"}, {"b - a"}}).size(), 1U);
  EXPECT_EQ(merged({{"a | b"}, {"a - b"}, {"b - a"}}).size(), 1U);
}

TEST(MergeByDominance, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const MergeResult result = result_of({{"a | b"}, {"b - c"}, {"c | d"}}, {.stop = stop.get_token()});
  EXPECT_EQ(result.merges, 0U);
  ASSERT_FALSE(result.trees.empty());
  for (const CsgTree& tree : result.trees) EXPECT_TRUE(test::is_well_formed(tree));
}

/// A long row of blocks that overlap, every third cut away.
TEST(MergeByDominance, CopesWithLongRows) {
  constexpr PrimitiveIndex k_count = 3000;
  std::vector<CsgTree> trees;
  std::vector<Clique> cliques;
  const auto is_cut = [](PrimitiveIndex p) { return p % 3 == 1; };
  for (PrimitiveIndex p = 0; p + 1 < k_count; ++p) {
    const CsgTree here = CsgTree::leaf(p);
    const CsgTree next = CsgTree::leaf(p + 1);
    trees.push_back(is_cut(p) ? subtract(next, here) : is_cut(p + 1) ? subtract(here, next) : unite(here, next));
    cliques.push_back({p, p + 1});
  }
  const MergeResult result = merge_by_dominance(trees, cliques);
  ASSERT_EQ(result.trees.size(), 1U);
  const CsgTree& tree = result.trees.front();
  EXPECT_EQ(tree.size(), 2 * k_count - 1);
  std::vector<bool> inside(k_count, false);
  for (PrimitiveIndex p = 0; p + 1 < k_count; p += 7) {
    inside[p] = true;
    EXPECT_EQ(contains(tree, inside), !is_cut(p)) << p;
    inside[p + 1] = true;
    EXPECT_EQ(contains(tree, inside), !is_cut(p) && !is_cut(p + 1)) << p;
    inside[p] = inside[p + 1] = false;
  }
}

}  // namespace
}  // namespace cloud2csg
