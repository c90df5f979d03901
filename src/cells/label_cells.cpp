#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <limits>

#include "cells/label_costs.hpp"
#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {
namespace {

/// Share of the points that lie where points are sparsest.
constexpr double k_sparse_share = 0.05;

/// Points per area of surface where it is seen badly: in clefts, and by few of the sensors.
double density_of(const CellComplex& complex) {
  struct Seen {
    double density, points;
  };
  std::vector<Seen> seen;
  double all = 0;
  for (const Patch& patch : complex.patches) {
    const double points = patch.first_in + patch.second_in;
    if (!(points > 0) || !(patch.area > 0)) continue;
    seen.push_back({points / patch.area, points});
    all += points;
  }
  std::ranges::sort(seen, {}, &Seen::density);
  double sum = 0;
  for (const Seen& patch : seen) {
    sum += patch.points;
    if (sum >= k_sparse_share * all) return patch.density;
  }
  return 0;
}

/// The minimum cut of a graph that is given edge by edge.
class MinimumCut {
 public:
  explicit MinimumCut(std::size_t nodes) : to_source_(nodes), to_sink_(nodes) {}

  /// The cost of having the node on the far side of the source, or of the sink.
  void add_source(CellIndex node, double cost) { to_source_[node] += cost; }
  void add_sink(CellIndex node, double cost) { to_sink_[node] += cost; }
  /// The cost of having two nodes on different sides.
  void add_edge(CellIndex a, CellIndex b, double cost) {
    if (cost > 0) edges_.push_back({a, b, cost});
  }

  /// Whether each node is on the source's side.
  [[nodiscard]] std::vector<bool> solve() const {
    const std::size_t nodes = to_source_.size();
    const std::size_t source = nodes;
    const std::size_t sink = nodes + 1;
    std::vector<Arc> arcs;
    arcs.reserve(2 * (edges_.size() + 2 * nodes));
    const auto connect = [&arcs](std::size_t a, std::size_t b, double there, double back) {
      arcs.push_back({a, b, there});
      arcs.push_back({b, a, back});
    };
    for (std::size_t node = 0; node < nodes; ++node) {
      // Only the difference matters.
      const double both = std::min(to_source_[node], to_sink_[node]);
      if (to_source_[node] > both) connect(source, node, to_source_[node] - both, 0);
      if (to_sink_[node] > both) connect(node, sink, to_sink_[node] - both, 0);
    }
    for (const Edge& edge : edges_) connect(edge.a, edge.b, edge.cost, edge.cost);
    return cut(nodes + 2, source, sink, arcs);
  }

 private:
  struct Edge {
    CellIndex a, b;
    double cost;
  };
  struct Arc {
    std::size_t from, to;
    double capacity;
  };

  static std::vector<bool> cut(std::size_t nodes, std::size_t source, std::size_t sink, const std::vector<Arc>& arcs) {
    using Graph = boost::compressed_sparse_row_graph<boost::directedS>;
    using ArcOfGraph = boost::graph_traits<Graph>::edge_descriptor;
    // The graph keeps its arcs sorted by their starts. `order` lists the arcs that way.
    std::vector<std::size_t> order(arcs.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, {}, [&arcs](std::size_t i) { return arcs[i].from; });
    std::vector<std::pair<std::size_t, std::size_t>> ends;
    std::vector<std::size_t> place(arcs.size());
    ends.reserve(arcs.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      ends.emplace_back(arcs[order[k]].from, arcs[order[k]].to);
      place[order[k]] = k;
    }
    const Graph graph(boost::edges_are_sorted, ends.begin(), ends.end(), nodes);
    std::vector<double> capacity(arcs.size());
    std::vector<ArcOfGraph> reverse(arcs.size());
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const std::size_t twin = i ^ 1U;
      capacity[place[i]] = arcs[i].capacity;
      reverse[place[i]] = ArcOfGraph(arcs[twin].from, place[twin]);
    }
    std::vector<double> residual(arcs.size());
    std::vector<ArcOfGraph> predecessor(nodes);
    std::vector<boost::default_color_type> colour(nodes);
    std::vector<std::size_t> distance(nodes);
    const auto by_arc = boost::get(boost::edge_index, graph);
    const auto by_node = boost::get(boost::vertex_index, graph);
    const auto map = [](auto& values, const auto& index) {
      return boost::make_iterator_property_map(values.begin(), index);
    };
    boost::boykov_kolmogorov_max_flow(graph, map(capacity, by_arc), map(residual, by_arc), map(reverse, by_arc),
                                      map(predecessor, by_node), map(colour, by_node), map(distance, by_node), by_node,
                                      source, sink);
    std::vector<bool> is_source(nodes - 2);
    for (std::size_t node = 0; node < is_source.size(); ++node) is_source[node] = colour[node] == boost::black_color;
    return is_source;
  }

  std::vector<double> to_source_, to_sink_;
  std::vector<Edge> edges_;
};

std::vector<bool> cheapest_labels(const CellComplex& complex, const LabelCosts& costs) {
  MinimumCut cut(complex.cells.size());
  for (CellIndex cell = 0; cell < complex.cells.size(); ++cell) {
    cut.add_source(cell, costs.if_out(cell));
    cut.add_sink(cell, costs.if_in(cell));
  }
  for (const CellIndex cell : complex.unbounded) cut.add_sink(cell, LabelCosts::k_forbidden);
  for (const LabelCosts::Border& border : costs.borders()) cut.add_edge(border.first, border.second, border.cost);
  return cut.solve();
}

/// The cost of changing each cell's label alone.
std::vector<double> evidence_of(const CellComplex& complex, const LabelCosts& costs, const std::vector<bool>& is_in) {
  std::vector<double> change(is_in.size());
  for (CellIndex cell = 0; cell < is_in.size(); ++cell) {
    change[cell] = costs.if_out(cell) - costs.if_in(cell);
    if (!is_in[cell]) change[cell] = -change[cell];
  }
  for (const LabelCosts::Border& border : costs.borders()) {
    const double more = is_in[border.first] == is_in[border.second] ? border.cost : -border.cost;
    change[border.first] += more;
    change[border.second] += more;
  }
  for (double& value : change) value = std::max(0.0, value);
  for (const CellIndex cell : complex.unbounded) change[cell] = std::numeric_limits<double>::infinity();
  return change;
}

}  // namespace

CellLabels label_cells(const CellComplex& complex, const LabelOptions& options) {
  CellLabels result{.density = density_of(complex), .options = options};
  const LabelCosts costs(complex, result.density, options);
  result.is_in = cheapest_labels(complex, costs);
  result.evidence = evidence_of(complex, costs, result.is_in);
  result.cost = costs.of([&result](CellIndex cell) { return result.is_in[cell]; });
  for (const Patch& patch : complex.patches) result.points += patch.first_in + patch.second_in;
  return result;
}

double cost_of(const CellComplex& complex, const std::vector<bool>& is_in, double density,
               const LabelOptions& options) {
  return LabelCosts(complex, density, options).of([&is_in](CellIndex cell) { return is_in[cell]; });
}

}  // namespace cloud2csg
