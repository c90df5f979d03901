#include "raw/solids/choose_faces.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <limits>
#include <map>

#include "core/base/disjoint_sets.hpp"

namespace cloud2csg {
namespace {

/// Share of a segment's price that an edge costs in the cut, so that it prefers the shorter of two equal borders.
constexpr double k_edge_share = 0.02;
constexpr int k_most_flip_sweeps = 6;

bool is_border(const CurveArrangement::Edge& edge, const FaceSet& faces) {
  return faces[edge.left] != faces[edge.right];
}

/// The edges at each vertex, or around each face.
using EdgeLists = std::vector<std::vector<std::uint32_t>>;

/// By the two numbers of each edge, below `count`.
EdgeLists edges_by(const CurveArrangement& arrangement, std::size_t count, std::uint32_t CurveArrangement::Edge::*one,
                   std::uint32_t CurveArrangement::Edge::*other) {
  EdgeLists lists(count);
  for (std::uint32_t e = 0; e < arrangement.edges.size(); ++e) {
    lists[arrangement.edges[e].*one].push_back(e);
    lists[arrangement.edges[e].*other].push_back(e);
  }
  return lists;
}

EdgeLists edges_at_vertices(const CurveArrangement& arrangement) {
  using Edge = CurveArrangement::Edge;
  return edges_by(arrangement, arrangement.vertices.size(), &Edge::start, &Edge::end);
}

EdgeLists edges_around_faces(const CurveArrangement& arrangement) {
  using Edge = CurveArrangement::Edge;
  return edges_by(arrangement, arrangement.areas.size(), &Edge::left, &Edge::right);
}

/// Ends of border segments at a vertex: a curve that arrives and goes on has none.
std::size_t segment_ends(const Drawing& drawing, const FaceSet& faces, std::span<const std::uint32_t> edges) {
  std::map<std::uint32_t, std::size_t> count;
  for (const std::uint32_t e : edges) {
    if (is_border(drawing.arrangement.edges[e], faces)) ++count[drawing.curve_of_edge[e]];
  }
  return static_cast<std::size_t>(
      std::ranges::count_if(count, [](const auto& entry) { return entry.second % 2 == 1; }));
}

namespace flow {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
using Graph = boost::adjacency_list<
    boost::vecS, boost::vecS, boost::directedS,
    boost::property<boost::vertex_color_t, boost::default_color_type,
                    boost::property<boost::vertex_distance_t, std::int64_t,
                                    boost::property<boost::vertex_predecessor_t, Traits::edge_descriptor>>>,
    boost::property<boost::edge_capacity_t, double,
                    boost::property<boost::edge_residual_capacity_t, double,
                                    boost::property<boost::edge_reverse_t, Traits::edge_descriptor>>>>;

void connect(Graph& graph, std::size_t from, std::size_t to, double forward, double backward) {
  const auto there = boost::add_edge(from, to, graph).first;
  const auto back = boost::add_edge(to, from, graph).first;
  boost::put(boost::edge_capacity, graph, there, forward);
  boost::put(boost::edge_capacity, graph, back, backward);
  boost::put(boost::edge_reverse, graph, there, back);
  boost::put(boost::edge_reverse, graph, back, there);
}

}  // namespace flow

FaceSet cut(const Drawing& drawing, std::span<const double> gains, double price_of_segment) {
  const std::size_t source = gains.size();
  const std::size_t sink = source + 1;
  flow::Graph graph(gains.size() + 2);
  // The outside stays out: no other set pays for that.
  double everything = 1;
  for (const double gain : gains) everything += std::max(gain, 0.0);
  flow::connect(graph, 0, sink, everything, 0);
  for (std::size_t face = 1; face < gains.size(); ++face) {
    if (gains[face] > 0) flow::connect(graph, source, face, gains[face], 0);
    if (gains[face] < 0) flow::connect(graph, face, sink, -gains[face], 0);
  }
  for (std::size_t e = 0; e < drawing.arrangement.edges.size(); ++e) {
    const CurveArrangement::Edge& edge = drawing.arrangement.edges[e];
    if (edge.left == edge.right) continue;
    const double price = drawing.price_of_edge[e] + k_edge_share * price_of_segment;
    flow::connect(graph, edge.left, edge.right, price, price);
  }
  boost::boykov_kolmogorov_max_flow(graph, source, sink);
  FaceSet faces(gains.size(), 0);
  const auto colour = boost::get(boost::vertex_color, graph);
  for (std::size_t face = 1; face < faces.size(); ++face) {
    faces[face] = colour[face] == boost::black_color ? 1 : 0;
  }
  return faces;
}

/// Changes single faces while that gains.
class Flips {
 public:
  Flips(const Drawing& drawing, std::span<const double> gains, double price_of_segment, const RunContext& run)
      : run_(run),
        drawing_(drawing),
        gains_(gains),
        price_(price_of_segment),
        at_vertex_(edges_at_vertices(drawing.arrangement)),
        around_face_(edges_around_faces(drawing.arrangement)) {}

  FaceSet apply_to(FaceSet faces) const {
    improve(faces);
    while (!run_.stop.stop_requested() && unpinch(faces)) {
    }
    improve(faces);
    return faces;
  }

 private:
  /// Whether the border touches itself in the vertex, or the axis in nothing else.
  [[nodiscard]] bool is_pinched(const FaceSet& faces, std::uint32_t vertex) const {
    std::size_t edges = 0;
    bool has_axis = false;
    for (const std::uint32_t e : at_vertex_[vertex]) {
      const CurveArrangement::Edge& edge = drawing_.arrangement.edges[e];
      if (!is_border(edge, faces)) continue;
      ++edges;
      has_axis = has_axis || edge.segment.is_on_axis();
    }
    const bool is_at_axis = drawing_.is_turned && drawing_.arrangement.vertices[vertex].x() == 0;
    return edges > 2 || (is_at_axis && edges > 0 && !has_axis);
  }

  [[nodiscard]] std::vector<std::uint32_t> vertices_around(std::size_t face) const {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t e : around_face_[face]) {
      const CurveArrangement::Edge& edge = drawing_.arrangement.edges[e];
      vertices.insert(vertices.end(), {edge.start, edge.end});
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  [[nodiscard]] std::ptrdiff_t pinches_around(const FaceSet& faces, std::size_t face) const {
    return std::ranges::count_if(vertices_around(face), [&](std::uint32_t v) { return is_pinched(faces, v); });
  }

  /// Changes the face that costs least among those that leave fewer pinched vertices. False if there is none.
  bool unpinch(FaceSet& faces) const {
    std::size_t best = 0;
    double least_loss = std::numeric_limits<double>::infinity();
    for (std::uint32_t v = 0; v < at_vertex_.size(); ++v) {
      if (!is_pinched(faces, v)) continue;
      for (const std::uint32_t e : at_vertex_[v]) {
        for (const std::uint32_t face : {drawing_.arrangement.edges[e].left, drawing_.arrangement.edges[e].right}) {
          if (face == 0) continue;
          const std::ptrdiff_t pinches = pinches_around(faces, face);
          double loss = local_net(faces, face);
          faces[face] ^= 1;
          loss -= local_net(faces, face);
          if (pinches_around(faces, face) < pinches && loss < least_loss) {
            least_loss = loss;
            best = face;
          }
          faces[face] ^= 1;
        }
      }
    }
    if (best != 0) faces[best] ^= 1;
    return best != 0;
  }

  void improve(FaceSet& faces) const {
    for (int sweep = 0; sweep < k_most_flip_sweeps && !run_.stop.stop_requested(); ++sweep) {
      bool has_changed = false;
      for (std::size_t face = 1; face < faces.size(); ++face) has_changed = flip(faces, face) || has_changed;
      if (!has_changed) break;
    }
  }

  /// Changes the face if that gains and pinches no vertex.
  bool flip(FaceSet& faces, std::size_t face) const {
    constexpr double k_rounding = 1e-12;
    const double before = local_net(faces, face);
    const std::ptrdiff_t pinches = pinches_around(faces, face);
    faces[face] ^= 1;
    if (local_net(faces, face) > before + k_rounding && pinches_around(faces, face) <= pinches) return true;
    faces[face] ^= 1;
    return false;
  }

  /// The part of the net gain that depends on the face.
  [[nodiscard]] double local_net(const FaceSet& faces, std::size_t face) const {
    double net = faces[face] != 0 ? gains_[face] : 0.0;
    for (const std::uint32_t e : around_face_[face]) {
      if (is_border(drawing_.arrangement.edges[e], faces)) net -= drawing_.price_of_edge[e];
    }
    std::size_t ends = 0;
    for (const std::uint32_t v : vertices_around(face)) ends += segment_ends(drawing_, faces, at_vertex_[v]);
    return net - 0.5 * price_ * static_cast<double>(ends);
  }

  const RunContext& run_;
  const Drawing& drawing_;
  std::span<const double> gains_;
  double price_;
  EdgeLists at_vertex_, around_face_;
};

}  // namespace

std::size_t segments_of(const Drawing& drawing, const FaceSet& faces) {
  const CurveArrangement& arrangement = drawing.arrangement;
  const EdgeLists at_vertex = edges_at_vertices(arrangement);
  std::size_t ends = 0;
  DisjointSets joined(arrangement.edges.size());  // border edges of one curve that meet in a vertex
  std::vector<std::uint8_t> has_end(arrangement.edges.size(), 0);
  for (const std::vector<std::uint32_t>& edges : at_vertex) {
    ends += segment_ends(drawing, faces, edges);
    for (const std::uint32_t e : edges) {
      if (!is_border(arrangement.edges[e], faces)) continue;
      bool goes_on = false;
      for (const std::uint32_t other : edges) {
        if (other == e || !is_border(arrangement.edges[other], faces)) continue;
        if (drawing.curve_of_edge[other] != drawing.curve_of_edge[e]) continue;
        joined.join(e, other);
        goes_on = true;
      }
      if (!goes_on) has_end[e] = 1;
    }
  }
  // A closed curve has no end.
  std::vector<std::uint8_t> group_has_end(arrangement.edges.size(), 0);
  for (std::size_t e = 0; e < has_end.size(); ++e) group_has_end[joined.root(e)] |= has_end[e];
  std::size_t closed = 0;
  for (std::size_t e = 0; e < has_end.size(); ++e) {
    closed += joined.root(e) == e && is_border(arrangement.edges[e], faces) && group_has_end[e] == 0 ? 1 : 0;
  }
  return ends / 2 + closed;
}

double border_price(const Drawing& drawing, const FaceSet& faces) {
  double price = 0;
  for (std::size_t e = 0; e < drawing.price_of_edge.size(); ++e) {
    if (is_border(drawing.arrangement.edges[e], faces)) price += drawing.price_of_edge[e];
  }
  return price;
}

double net_gain(const Drawing& drawing, std::span<const double> gains, double price_of_segment, const FaceSet& faces) {
  double net = -price_of_segment * static_cast<double>(segments_of(drawing, faces));
  for (std::size_t face = 1; face < faces.size(); ++face) net += faces[face] != 0 ? gains[face] : 0.0;
  return net - border_price(drawing, faces);
}

FaceSet choose_faces(const Drawing& drawing, std::span<const double> gains, double price_of_segment,
                     const RunContext& run) {
  return Flips(drawing, gains, price_of_segment, run).apply_to(cut(drawing, gains, price_of_segment));
}

}  // namespace cloud2csg
