#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <boost/graph/bron_kerbosch_all_cliques.hpp>
#include <boost/graph/undirected_graph.hpp>
#include <numeric>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

using BoostGraph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;

OverlapGraph make_graph(std::size_t size, const std::vector<std::pair<PrimitiveIndex, PrimitiveIndex>>& edges) {
  OverlapGraph graph;
  graph.neighbours.resize(size);
  for (const auto& [a, b] : edges) {
    graph.neighbours[a].push_back(b);
    graph.neighbours[b].push_back(a);
  }
  for (auto& list : graph.neighbours) std::sort(list.begin(), list.end());
  return graph;
}

OverlapGraph random_graph(std::size_t size, double density, RandomStream& random) {
  std::vector<std::pair<PrimitiveIndex, PrimitiveIndex>> edges;
  for (PrimitiveIndex a = 0; a < size; ++a) {
    for (PrimitiveIndex b = a + 1; b < size; ++b) {
      if (random.chance(density)) edges.emplace_back(a, b);
    }
  }
  return make_graph(size, edges);
}

OverlapGraph complete_graph(std::size_t size) {
  RandomStream random(0);
  return random_graph(size, 2.0, random);
}

struct CollectCliques {
  std::vector<Clique>* cliques;
  template <typename CliqueOfBoost, typename Graph>
  void clique(const CliqueOfBoost& found, const Graph& /*graph*/) {
    Clique clique;
    for (const auto vertex : found) clique.push_back(static_cast<PrimitiveIndex>(vertex));
    std::sort(clique.begin(), clique.end());
    cliques->push_back(std::move(clique));
  }
};

std::vector<Clique> boost_cliques(const OverlapGraph& graph) {
  BoostGraph other(graph.size());
  for (PrimitiveIndex a = 0; a < graph.size(); ++a) {
    for (const PrimitiveIndex b : graph.neighbours[a]) {
      if (a < b) boost::add_edge(a, b, other);
    }
  }
  std::vector<Clique> cliques;
  boost::bron_kerbosch_all_cliques(other, CollectCliques{&cliques}, 1);
  std::sort(cliques.begin(), cliques.end());
  return cliques;
}

TEST(MaximalCliques, NoPrimitivesNoCliques) {
  EXPECT_TRUE(maximal_cliques({}).empty());
  EXPECT_TRUE(clique_histogram({}).empty());
  EXPECT_TRUE(connected_components({}).empty());
}

TEST(MaximalCliques, PrimitiveWithoutNeighboursIsACliqueOfOne) {
  const OverlapGraph graph = make_graph(4, {{1, 2}});
  EXPECT_EQ(maximal_cliques(graph), (std::vector<Clique>{{0}, {1, 2}, {3}}));
}

TEST(MaximalCliques, CompleteGraphIsOneClique) {
  const auto cliques = maximal_cliques(complete_graph(9));
  ASSERT_EQ(cliques.size(), 1U);
  Clique all(9);
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(cliques[0], all);
}

TEST(MaximalCliques, MoonMoserGraphHasThreeToTheThirdPower) {
  // Complement of four triangles: the graph of twelve vertices with the most maximal cliques, 3^4.
  std::vector<std::pair<PrimitiveIndex, PrimitiveIndex>> edges;
  for (PrimitiveIndex a = 0; a < 12; ++a) {
    for (PrimitiveIndex b = a + 1; b < 12; ++b) {
      if (a / 3 != b / 3) edges.emplace_back(a, b);
    }
  }
  EXPECT_EQ(maximal_cliques(make_graph(12, edges)).size(), 81U);
}

RC_GTEST_PROP(MaximalCliques, EqualsBoostOnRandomGraphs, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const auto size = *rc::gen::inRange<std::size_t>(0, 40);
  const OverlapGraph graph = random_graph(size, random.uniform(), random);
  RC_ASSERT(maximal_cliques(graph) == boost_cliques(graph));
}

TEST(MaximalCliques, EqualsBoostOnALargeSparseGraph) {
  RandomStream random(7);
  const OverlapGraph graph = random_graph(1000, 0.01, random);
  EXPECT_EQ(maximal_cliques(graph), boost_cliques(graph));
}

TEST(CliqueHistogram, CountsBySize) {
  const std::vector<Clique> cliques{{0}, {1, 2}, {3, 4}, {5, 6, 7, 8}};
  EXPECT_EQ(clique_histogram(cliques), (std::vector<std::size_t>{1, 2, 0, 1}));
}

TEST(ConnectedComponents, AreOrderedByTheirFirstPrimitive) {
  const OverlapGraph graph = make_graph(6, {{0, 5}, {5, 3}, {1, 4}});
  EXPECT_EQ(connected_components(graph), (std::vector<std::vector<PrimitiveIndex>>{{0, 3, 5}, {1, 4}, {2}}));
}

TEST(OverlapGraph, KnowsItsEdges) {
  const OverlapGraph graph = make_graph(4, {{0, 2}, {2, 3}});
  EXPECT_EQ(graph.edge_count(), 2U);
  EXPECT_TRUE(graph.has_edge(2, 0));
  EXPECT_TRUE(graph.has_edge(0, 2));
  EXPECT_FALSE(graph.has_edge(0, 3));
}

}  // namespace
}  // namespace cloud2csg
