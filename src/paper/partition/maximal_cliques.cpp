#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "cloud2csg/advanced/overlap_graph.hpp"

namespace cloud2csg {
namespace {

using Vertices = std::vector<PrimitiveIndex>;  ///< ascending

Vertices common(const Vertices& a, const Vertices& b) {
  Vertices both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

Vertices difference(const Vertices& a, const Vertices& b) {
  Vertices rest;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
  return rest;
}

std::size_t common_count(const Vertices& a, const Vertices& b) {
  std::size_t count = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) ++count;
    const bool step_i = *i <= *j;
    const bool step_j = *j <= *i;
    i += step_i ? 1 : 0;
    j += step_j ? 1 : 0;
  }
  return count;
}

void insert_sorted(Vertices& vertices, PrimitiveIndex vertex) {
  vertices.insert(std::lower_bound(vertices.begin(), vertices.end(), vertex), vertex);
}

void erase_sorted(Vertices& vertices, PrimitiveIndex vertex) {
  vertices.erase(std::lower_bound(vertices.begin(), vertices.end(), vertex));
}

/// An order in which each vertex has the fewest neighbours among those left (Matula and Beck). O(n + edges).
Vertices degeneracy_order(const OverlapGraph& graph) {
  std::vector<std::size_t> degree(graph.size());
  std::vector<Vertices> by_degree(graph.size() + 1);
  for (PrimitiveIndex v = 0; v < graph.size(); ++v) {
    degree[v] = graph.neighbours[v].size();
    by_degree[degree[v]].push_back(v);
  }
  std::vector<bool> done(graph.size(), false);
  Vertices order;
  for (std::size_t lowest = 0; order.size() < graph.size();) {
    if (by_degree[lowest].empty()) {
      ++lowest;
      continue;
    }
    const PrimitiveIndex v = by_degree[lowest].back();
    by_degree[lowest].pop_back();
    if (done[v] || degree[v] != lowest) continue;  // outdated: its degree has fallen
    done[v] = true;
    order.push_back(v);
    for (const PrimitiveIndex w : graph.neighbours[v]) {
      if (!done[w]) by_degree[--degree[w]].push_back(w);
    }
    lowest = lowest > 0 ? lowest - 1 : 0;
  }
  return order;
}

/// Bron and Kerbosch 1973, with the pivot of Tomita, Tanaka and Takahashi 2006.
class CliqueSearch {
 public:
  explicit CliqueSearch(const OverlapGraph& graph) : graph_(graph) {}

  /// Reports every maximal clique with all of `clique`, any of `candidates` and none of `excluded`.
  void extend(Clique& clique, Vertices candidates, Vertices excluded) {
    if (candidates.empty()) {
      if (excluded.empty()) cliques_.push_back(clique);
      return;
    }
    const Vertices& covered = graph_.neighbours[pivot(candidates, excluded)];
    for (const PrimitiveIndex v : difference(candidates, covered)) {
      const Vertices& neighbours = graph_.neighbours[v];
      clique.push_back(v);
      extend(clique, common(candidates, neighbours), common(excluded, neighbours));
      clique.pop_back();
      erase_sorted(candidates, v);
      insert_sorted(excluded, v);
    }
  }

  [[nodiscard]] std::vector<Clique> take() { return std::move(cliques_); }

 private:
  /// The vertex with the most neighbours among the candidates. Only the other candidates need branches.
  [[nodiscard]] PrimitiveIndex pivot(const Vertices& candidates, const Vertices& excluded) const {
    PrimitiveIndex best = candidates.front();
    std::size_t best_count = 0;
    for (const Vertices* side : {&candidates, &excluded}) {
      for (const PrimitiveIndex v : *side) {
        const std::size_t count = common_count(candidates, graph_.neighbours[v]);
        if (count > best_count) best = v, best_count = count;
      }
    }
    return best;
  }

  const OverlapGraph& graph_;
  std::vector<Clique> cliques_;
};

}  // namespace

std::vector<Clique> maximal_cliques(const OverlapGraph& graph) {
  const Vertices order = degeneracy_order(graph);
  std::vector<std::size_t> rank(graph.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = i;

  CliqueSearch search(graph);
  for (const PrimitiveIndex v : order) {
    Vertices later;
    Vertices earlier;
    for (const PrimitiveIndex w : graph.neighbours[v]) (rank[w] > rank[v] ? later : earlier).push_back(w);
    Clique clique{v};
    search.extend(clique, std::move(later), std::move(earlier));
  }
  std::vector<Clique> cliques = search.take();
  for (Clique& clique : cliques) std::sort(clique.begin(), clique.end());
  std::sort(cliques.begin(), cliques.end());
  return cliques;
}

std::vector<std::size_t> clique_histogram(std::span<const Clique> cliques) {
  std::vector<std::size_t> histogram;
  for (const Clique& clique : cliques) {
    if (clique.size() > histogram.size()) histogram.resize(clique.size());
    ++histogram[clique.size() - 1];
  }
  return histogram;
}

std::vector<std::vector<PrimitiveIndex>> connected_components(const OverlapGraph& graph) {
  std::vector<std::vector<PrimitiveIndex>> components;
  std::vector<bool> seen(graph.size(), false);
  for (PrimitiveIndex first = 0; first < graph.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<PrimitiveIndex> component{first};
    for (std::size_t next = 0; next < component.size(); ++next) {
      for (const PrimitiveIndex neighbour : graph.neighbours[component[next]]) {
        if (seen[neighbour]) continue;
        seen[neighbour] = true;
        component.push_back(neighbour);
      }
    }
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace cloud2csg
