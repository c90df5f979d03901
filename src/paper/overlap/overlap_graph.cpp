#include "cloud2csg/advanced/overlap_graph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/primitive/bounds_index.hpp"
#include "paper/overlap/narrow_phase.hpp"

namespace cloud2csg {
namespace {

/// Pairs between looks at the stop token: a pair of convex solids takes about a microsecond.
constexpr std::size_t k_pairs_between_stops = 1024;

std::vector<OverlapBody> make_bodies(const PrimitiveSet& primitives, const OverlapOptions& options) {
  std::vector<OverlapBody> bodies;
  bodies.reserve(primitives.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    bodies.push_back(make_overlap_body(primitives[i], i < options.extents.size() ? options.extents[i] : std::nullopt));
  }
  return bodies;
}

/// Pairs whose bounds meet: by the R-tree for bounded solids, all pairs for unbounded ones.
class BroadPhase {
 public:
  BroadPhase(const std::vector<OverlapBody>& bodies, double margin) : bodies_(bodies), margin_(margin) {
    std::vector<IndexEntry> entries;
    for (PrimitiveIndex i = 0; i < bodies.size(); ++i) {
      if (bodies[i].is_bounded()) entries.emplace_back(to_index_box(bodies[i].bounds, margin), i);
    }
    index_ = BoundsIndex(entries);  // from a range: packed, O(n log n)
  }

  /// Primitives that may overlap primitive i. Each pair comes for one of its members only.
  [[nodiscard]] std::vector<PrimitiveIndex> partners(PrimitiveIndex i) const {
    std::vector<PrimitiveIndex> found;
    if (!bodies_[i].is_bounded()) {
      for (PrimitiveIndex other = 0; other < bodies_.size(); ++other) {
        if (other > i || bodies_[other].is_bounded()) found.push_back(other);
      }
      return found;
    }
    const IndexBox box = to_index_box(bodies_[i].bounds, margin_);
    for (auto hit = index_.qbegin(boost::geometry::index::intersects(box)); hit != index_.qend(); ++hit) {
      if (hit->second > i) found.push_back(hit->second);
    }
    return found;
  }

 private:
  const std::vector<OverlapBody>& bodies_;
  double margin_;
  BoundsIndex index_;
};

}  // namespace

bool OverlapGraph::has_edge(PrimitiveIndex a, PrimitiveIndex b) const {
  return std::binary_search(neighbours[a].begin(), neighbours[a].end(), b);
}

std::size_t OverlapGraph::edge_count() const {
  std::size_t ends = 0;
  for (const auto& list : neighbours) ends += list.size();
  return ends / 2;
}

std::optional<OptionConflict> conflict_in(const OverlapOptions& options) {
  for (std::size_t i = 0; i < options.extents.size(); ++i) {
    if (!options.extents[i]) continue;
    const Eigen::Vector3d& half = options.extents[i]->half_size;
    if (half.allFinite() && half.minCoeff() >= 0) continue;
    return OptionConflict{fmt::format("extents[{}]", i), "expected a finite box with sizes of 0 or more"};
  }
  return std::nullopt;
}

OverlapGraph build_overlap_graph(const PrimitiveSet& primitives, const OverlapOptions& options, const RunContext& run) {
  validate(options);
  const std::vector<OverlapBody> bodies = make_bodies(primitives, options);
  const BroadPhase broad_phase(bodies, options.tolerance / 2);
  OverlapGraph graph;
  graph.neighbours.resize(primitives.size());
  std::size_t pairs = 0;
  for (PrimitiveIndex i = 0; i < bodies.size(); ++i) {
    run.report("overlap", i, bodies.size(), "primitives");
    for (const PrimitiveIndex j : broad_phase.partners(i)) {
      if (pairs++ % k_pairs_between_stops == 0) run.throw_if_stopped();
      if (!bodies_overlap(bodies[i], bodies[j], options.tolerance, run)) continue;
      graph.neighbours[i].push_back(j);
      graph.neighbours[j].push_back(i);
    }
  }
  for (auto& list : graph.neighbours) std::sort(list.begin(), list.end());
  run.report("overlap", bodies.size(), bodies.size(), "primitives");
  return graph;
}

}  // namespace cloud2csg
