#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/base/parallel.hpp"
#include "shape/mesh/contour.hpp"

namespace cloud2csg {
namespace {

// Normals within a few degrees count as one: a flatter edge is not worth keeping.
constexpr double k_sheet_cutoff = 2e-3;
// Planes of neighbouring sheets also vary by curvature, so a corner must be clearer.
constexpr double k_corner_cutoff = 2e-2;
// In cells: how far an edge or corner may miss its planes and the surface.
constexpr double k_feature_tolerance = 2e-2;
// Distance from the cell's border, so that vertices of different cells never coincide.
constexpr double k_cell_margin = 1e-3;
// In cells: a vertex this close is on the surface.
constexpr double k_surface_tolerance = 1e-6;

/// A better position for a vertex, outside its cell or found from its neighbours.
struct Proposal {
  std::uint32_t vertex;
  Eigen::Vector3d position;
  Eigen::Vector3i from_cell;
  bool is_corner;  ///< else on a sharp edge

  /// From the middle of the vertex's own cell.
  [[nodiscard]] double distance() const {
    return (position - (from_cell.cast<double>() + Eigen::Vector3d::Constant(0.5))).norm();
  }
};

Eigen::Vector3i cell_of(const Eigen::Vector3d& position) {
  return position.array().floor().cast<int>();
}

class VertexPlacer {
 public:
  VertexPlacer(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
               const Contour& contour, const RunContext& run)
      : field_(field),
        cells_(cells),
        primitives_(primitives),
        contour_(contour),
        run_(run),
        placement_{.positions = {},
                   .in_cell = std::vector<Eigen::Vector3d>(contour.quadrics.size()),
                   .kinds = std::vector<VertexKind>(contour.quadrics.size(), VertexKind::in_cell)},
        ranks_(contour.quadrics.size()),
        proposals_(field.blocks().size()) {}

  Placement place() {
    for_each_index(field_.blocks().size(), run_, [&](std::size_t slot) { place_in_cells(slot); });
    const std::vector<Quadric> rings = gather_rings();
    for_each_index(field_.blocks().size(), run_, [&](std::size_t slot) {
      propose_corners(slot, rings);
      drop_off_surface(slot);
      project(slot);
    });
    placement_.positions = placement_.in_cell;
    take_proposals();
    return std::move(placement_);
  }

 private:
  template <typename Visit>
  void for_each_vertex(std::size_t slot, const Visit& visit) const {
    for (const SurfaceCell& cell : cells_.cells_of_block(slot)) {
      for (int loop = 0; loop < cell.loops.count; ++loop)
        visit(cell.first_vertex + static_cast<std::uint32_t>(loop), cell.cell);
    }
  }

  static Eigen::Vector3d lowest_within(const Eigen::Vector3i& cell) {
    return cell.cast<double>().array() + k_cell_margin;
  }
  static Eigen::Vector3d highest_within(const Eigen::Vector3i& cell) {
    return cell.cast<double>().array() + (1.0 - k_cell_margin);
  }
  static bool is_within(const Eigen::Vector3d& position, const Eigen::Vector3i& cell) {
    return (position.array() >= lowest_within(cell).array()).all() &&
           (position.array() <= highest_within(cell).array()).all();
  }

  /// Tips of corners and edges may slip into a cell whose signs do not show them, but never further than one cell.
  static bool is_near(const Eigen::Vector3d& position, const Eigen::Vector3i& cell) {
    return (cell_of(position) - cell).cwiseAbs().maxCoeff() <= 1;
  }

  void place_in_cells(std::size_t slot) {
    for_each_vertex(slot, [&](std::uint32_t vertex, const Eigen::Vector3i& cell) {
      const Quadric& quadric = contour_.quadrics[vertex];
      const auto [point, rank, sharpness] = quadric.minimum(k_sheet_cutoff);
      ranks_[vertex] = rank;
      placement_.in_cell[vertex] = point;
      const bool is_corner = sharpness > k_corner_cutoff;
      if (is_corner) placement_.kinds[vertex] = VertexKind::corner;
      if (is_within(point, cell)) return;
      if (rank > 1 && is_near(point, cell)) proposals_[slot].push_back({vertex, point, cell, is_corner});
      placement_.in_cell[vertex] = quadric.minimum_within(lowest_within(cell), highest_within(cell));
    });
  }

  /// For vertices at or beside sharp edges: the planes of all sheets around them.
  [[nodiscard]] std::vector<Quadric> gather_rings() const {
    std::vector<Quadric> rings(ranks_.size());
    for (const std::vector<Quad>& quads : contour_.quads) {
      for (const Quad& quad : quads) {
        int sharpest = 0;
        for (const std::uint32_t vertex : quad.vertices) sharpest = std::max(sharpest, ranks_[vertex]);
        if (sharpest < 2) continue;
        Quadric all;
        for (const std::uint32_t vertex : quad.vertices) all.add(contour_.quadrics[vertex]);
        for (const std::uint32_t vertex : quad.vertices) rings[vertex].add(all);
      }
    }
    return rings;
  }

  /// Finds a corner from the surrounding cells if not all of its faces cross the edges of one cell.
  void propose_corners(std::size_t slot, const std::vector<Quadric>& rings) {
    for_each_vertex(slot, [&](std::uint32_t vertex, const Eigen::Vector3i& cell) {
      if (ranks_[vertex] > 2 || rings[vertex].empty()) return;
      const Quadric::Minimum corner = rings[vertex].minimum(k_corner_cutoff);
      if (corner.rank < 3 || !is_near(corner.point, cell)) return;
      if (rings[vertex].residual(corner.point) > k_feature_tolerance) return;
      proposals_[slot].push_back({vertex, corner.point, cell, true});
    });
  }

  void drop_off_surface(std::size_t slot) {
    std::vector<Proposal>& proposals = proposals_[slot];
    Points points;
    for (const Proposal& proposal : proposals) points.push_back(field_.grid().to_world(proposal.position));
    const std::vector<double> values = implicit_value(field_.blocks()[slot].tree, primitives_, points);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < proposals.size(); ++i) {
      if (std::abs(values[i]) <= k_feature_tolerance * field_.grid().spacing) proposals[kept++] = proposals[i];
    }
    proposals.resize(kept);
  }

  /// Newton steps onto the surface, within the vertices' cells.
  void project(std::size_t slot) {
    constexpr int k_newton_steps = 8;
    std::vector<Placed> open;
    for_each_vertex(slot, [&](std::uint32_t vertex, const Eigen::Vector3i& cell) { open.push_back({vertex, cell}); });
    for (int step = 0; step < k_newton_steps && !open.empty(); ++step) open = step_to_surface(slot, open);
  }

  struct Placed {
    std::uint32_t vertex;
    Eigen::Vector3i cell;
  };

  /// Returns the vertices that are not yet on the surface.
  std::vector<Placed> step_to_surface(std::size_t slot, const std::vector<Placed>& vertices) {
    const CsgTree& tree = field_.blocks()[slot].tree;
    const double spacing = field_.grid().spacing;
    Points points;
    for (const Placed& placed : vertices) points.push_back(field_.grid().to_world(placement_.in_cell[placed.vertex]));
    const std::vector<double> values = implicit_value(tree, primitives_, points);
    const Points gradients = implicit_gradient(tree, primitives_, points);
    std::vector<Placed> open;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d step = gradients[i] * (values[i] / (gradients[i].squaredNorm() * spacing));
      if (std::abs(values[i]) <= k_surface_tolerance * spacing || !step.allFinite()) continue;
      Eigen::Vector3d& position = placement_.in_cell[vertices[i].vertex];
      const Eigen::Vector3d low = lowest_within(vertices[i].cell);
      position = (position - step).cwiseMax(low).cwiseMin(highest_within(vertices[i].cell));
      open.push_back(vertices[i]);
    }
    return open;
  }

  /// Nearest first: if several cells find a corner, it goes to the vertex that moves least.
  void take_proposals() {
    std::vector<Proposal> all;
    for (const std::vector<Proposal>& proposals : proposals_) {
      all.insert(all.end(), proposals.begin(), proposals.end());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Proposal& a, const Proposal& b) { return a.distance() < b.distance(); });
    std::map<std::array<int, 3>, std::vector<std::uint32_t>> moved_into;
    for (const Proposal& proposal : all) {
      const Eigen::Vector3i cell = cell_of(proposal.position);
      std::vector<std::uint32_t>& moved = moved_into[{cell.x(), cell.y(), cell.z()}];
      if (is_taken(proposal, moved)) continue;
      placement_.positions[proposal.vertex] = proposal.position;
      placement_.kinds[proposal.vertex] = proposal.is_corner ? VertexKind::corner : VertexKind::outlying_edge;
      moved.push_back(proposal.vertex);
    }
  }

  /// Whether a vertex of that cell, or one moved into it, is already at the place.
  [[nodiscard]] bool is_taken(const Proposal& proposal, std::span<const std::uint32_t> moved) const {
    const auto at_same_place = [&](std::uint32_t vertex) {
      return vertex != proposal.vertex && (placement_.positions[vertex] - proposal.position).norm() < k_cell_margin;
    };
    if (std::any_of(moved.begin(), moved.end(), at_same_place)) return true;
    const SurfaceCell* cell = cells_.find(cell_of(proposal.position));
    if (cell == nullptr) return false;
    for (int loop = 0; loop < cell->loops.count; ++loop) {
      if (at_same_place(cell->first_vertex + static_cast<std::uint32_t>(loop))) return true;
    }
    return false;
  }

  const SparseField& field_;
  const SurfaceCells& cells_;
  const PrimitiveSet& primitives_;
  const Contour& contour_;
  const RunContext& run_;
  Placement placement_;
  std::vector<int> ranks_;                        ///< by vertex
  std::vector<std::vector<Proposal>> proposals_;  ///< by block
};

}  // namespace

Placement place_vertices(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
                         const Contour& contour, const RunContext& run) {
  return VertexPlacer(field, cells, primitives, contour, run).place();
}

}  // namespace cloud2csg
