#include "shape/mesh/contour.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/parallel.hpp"
#include "shape/mesh/surface_cells.hpp"

namespace cloud2csg {
namespace {

struct Crossing {
  Eigen::Vector3i corner;  ///< lower end of the edge
  int axis;
  bool from_inside;        ///< whether the lower end is inside
  Eigen::Vector3d point;   ///< grid coordinates
  Eigen::Vector3d normal;  ///< outward, unit length
};

/// The crossings on all edges of a block's surface cells, far sides included. Each edge occurs once.
class BlockCrossings {
 public:
  BlockCrossings(const Block& block, const Grid& grid, std::span<const SurfaceCell> cells,
                 const PrimitiveSet& primitives);

  [[nodiscard]] std::span<const Crossing> all() const { return crossings_; }
  /// Precondition: the edge of the cell is crossed.
  [[nodiscard]] const Crossing& at(const SurfaceCell& cell, int edge) const;

 private:
  [[nodiscard]] std::size_t position(const SurfaceCell& cell, int edge) const;

  Eigen::Vector3i first_cell_;
  std::vector<Crossing> crossings_;
  std::vector<int> index_;  ///< by local corner and axis: index into crossings_, or -1
};

// In cells: far below a visible error of a vertex, far above the rounding of a distance.
constexpr double k_root_tolerance = 1e-10;
constexpr int k_most_steps = 60;

Eigen::Vector3i corner_offset(int corner) {
  return {corner & 1, (corner >> 1) & 1, corner >> 2};
}

/// Finds a root on each of many edges, in joint steps that evaluate the solid in batches. Regula falsi with the
/// Illinois rule: one step if the value is linear along the edge, as on a plane.
class RootFinder {
 public:
  RootFinder(const Block& block, const Grid& grid, const PrimitiveSet& primitives, std::span<Crossing> crossings)
      : block_(block), grid_(grid), primitives_(primitives), crossings_(crossings), brackets_(crossings.size()) {}

  void run() {
    std::vector<std::size_t> open(crossings_.size());
    std::iota(open.begin(), open.end(), std::size_t{0});
    start(open);
    for (int step = 0; step < k_most_steps && !open.empty(); ++step) {
      for (const std::size_t i : open) crossings_[i].point = point_at(i, brackets_[i].next());
      const std::vector<double> values = values_at_points(open);
      std::vector<std::size_t> still_open;
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (!brackets_[open[k]].update(values[k], k_root_tolerance * grid_.spacing)) still_open.push_back(open[k]);
      }
      open = std::move(still_open);
    }
    set_normals();
  }

 private:
  /// The root lies between parameters 0 (lower end of the edge) and 1.
  struct Bracket {
    double low = 0, high = 1;
    double value_low = 0, value_high = 0;  ///< with opposite signs; the Illinois rule halves them
    double tried = 0;
    int last_moved = 0;

    double next() {
      const double part = value_low / (value_low - value_high);
      tried = std::isfinite(part) ? low + (high - low) * part : 0.5 * (low + high);
      return tried;
    }

    bool update(double value, double tolerance) {
      if (std::abs(value) <= tolerance) return true;
      const bool is_low = (value < 0) == (value_low < 0);
      (is_low ? low : high) = tried;
      (is_low ? value_low : value_high) = value;
      const int moved = is_low ? -1 : 1;
      if (moved == last_moved) (is_low ? value_high : value_low) *= 0.5;
      last_moved = moved;
      return high - low <= k_root_tolerance;
    }
  };

  [[nodiscard]] Eigen::Vector3d point_at(std::size_t i, double parameter) const {
    Eigen::Vector3d point = crossings_[i].corner.cast<double>();
    point[crossings_[i].axis] += parameter;
    return point;
  }

  [[nodiscard]] std::vector<double> values_at_points(std::span<const std::size_t> indices) const {
    Points points;
    points.reserve(indices.size());
    for (const std::size_t i : indices) points.push_back(grid_.to_world(crossings_[i].point));
    return implicit_value(block_.tree, primitives_, points);
  }

  void start(std::span<const std::size_t> all) {
    for (const double end : {0.0, 1.0}) {
      for (const std::size_t i : all) crossings_[i].point = point_at(i, end);
      const std::vector<double> values = values_at_points(all);
      for (const std::size_t i : all) (end == 0.0 ? brackets_[i].value_low : brackets_[i].value_high) = values[i];
    }
  }

  void set_normals() {
    Points points;
    points.reserve(crossings_.size());
    for (const Crossing& crossing : crossings_) points.push_back(grid_.to_world(crossing.point));
    const Points gradients = implicit_gradient(block_.tree, primitives_, points);
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
      const Eigen::Vector3d gradient = gradients[i];
      const double length = gradient.norm();
      // Without a gradient, the edge from inside to outside is the best guess.
      const Eigen::Vector3d along =
          (crossings_[i].from_inside ? 1.0 : -1.0) * Eigen::Vector3d::Unit(crossings_[i].axis);
      crossings_[i].normal = length > 0 && std::isfinite(length) ? Eigen::Vector3d(gradient / length) : along;
    }
  }

  const Block& block_;
  const Grid& grid_;
  const PrimitiveSet& primitives_;
  std::span<Crossing> crossings_;
  std::vector<Bracket> brackets_;
};

BlockCrossings::BlockCrossings(const Block& block, const Grid& grid, std::span<const SurfaceCell> cells,
                               const PrimitiveSet& primitives)
    : first_cell_(block.first_cell), index_(std::size_t{3} * k_layer * k_layer * k_layer, -1) {
  for (const SurfaceCell& cell : cells) {
    const EdgeMask crossed = crossed_edges(cell.signs);
    for (int edge = 0; edge < k_cell_edges; ++edge) {
      if (((crossed >> edge) & 1) == 0) continue;
      int& index = index_[position(cell, edge)];
      if (index >= 0) continue;
      index = static_cast<int>(crossings_.size());
      crossings_.push_back({.corner = cell.cell + corner_offset(edge_low_corner(edge)),
                            .axis = edge / 4,
                            .from_inside = is_inside(cell.signs, edge_low_corner(edge)),
                            .point = {},
                            .normal = {}});
    }
  }
  RootFinder(block, grid, primitives, crossings_).run();
}

const Crossing& BlockCrossings::at(const SurfaceCell& cell, int edge) const {
  return crossings_[static_cast<std::size_t>(index_[position(cell, edge)])];
}

std::size_t BlockCrossings::position(const SurfaceCell& cell, int edge) const {
  const Eigen::Vector3i local = cell.cell + corner_offset(edge_low_corner(edge)) - first_cell_;
  const int corner = local.x() + k_layer * (local.y() + k_layer * local.z());
  return std::size_t{3} * static_cast<std::size_t>(corner) + static_cast<std::size_t>(edge / 4);
}

/// The four cells around an edge in cyclic order, and the edge's number in each.
Quad quad_around(const Crossing& crossing, const SurfaceCells& cells) {
  constexpr std::array<std::array<int, 2>, 4> k_steps = {{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
  const int u = (crossing.axis + 1) % 3;
  const int v = (crossing.axis + 2) % 3;
  Quad quad = {};
  for (std::size_t i = 0; i < 4; ++i) {
    Eigen::Vector3i cell = crossing.corner;
    cell[u] += k_steps[i][0];
    cell[v] += k_steps[i][1];
    const int edge = 4 * crossing.axis - k_steps[i][0] - 2 * k_steps[i][1];
    // Counter-clockwise seen from the outside end of the edge.
    quad.vertices[crossing.from_inside ? i : 3 - i] = cells.vertex_at(cell, edge);
  }
  return quad;
}

bool owns(const Block& block, const Eigen::Vector3i& corner) {
  return ((corner - block.first_cell).array() < k_block_cells).all();
}

}  // namespace

double Quadric::residual(const Eigen::Vector3d& x) const {
  const double sum = x.dot(matrix_ * x) - 2.0 * vector_.dot(x) + constant_;
  return std::sqrt(std::max(sum, 0.0) / count_);
}

Quadric::Minimum Quadric::minimum(double cutoff) const {
  const Eigen::Vector3d mean = mean_point();
  const Eigen::Vector3d rest = vector_ - matrix_ * mean;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix_);
  const Eigen::Vector3d& eigenvalues = solver.eigenvalues();  // ascending
  Minimum minimum{.point = mean, .rank = 0, .sharpness = eigenvalues[0] / eigenvalues[2]};
  for (int i = 2; i >= 0 && eigenvalues[i] > cutoff * eigenvalues[2]; --i) {
    const Eigen::Vector3d direction = solver.eigenvectors().col(i);
    minimum.point += direction * (direction.dot(rest) / eigenvalues[i]);
    ++minimum.rank;
  }
  return minimum;
}

Eigen::Vector3d Quadric::minimum_within(const Eigen::Vector3d& low, const Eigen::Vector3d& high) const {
  // Coordinate descent. A weak pull towards the mean point makes the minimum unique.
  constexpr int k_rounds = 32;
  constexpr double k_pull = 1e-3;
  const Eigen::Vector3d mean = mean_point();
  const Eigen::Matrix3d matrix = matrix_ + k_pull * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d vector = vector_ + k_pull * mean;
  Eigen::Vector3d x = mean.cwiseMax(low).cwiseMin(high);
  for (int round = 0; round < k_rounds; ++round) {
    for (int i = 0; i < 3; ++i) {
      const double others = matrix.row(i).dot(x) - matrix(i, i) * x[i];
      x[i] = std::clamp((vector[i] - others) / matrix(i, i), low[i], high[i]);
    }
  }
  return x;
}

Contour trace_contour(const SparseField& field, const SurfaceCells& cells, const PrimitiveSet& primitives,
                      const RunContext& run) {
  Contour contour{.quadrics = std::vector<Quadric>(cells.vertex_count()),
                  .quads = std::vector<std::vector<Quad>>(field.blocks().size())};
  for_each_index(field.blocks().size(), run, [&](std::size_t slot) {
    const Block& block = field.blocks()[slot];
    const std::span<const SurfaceCell> block_cells = cells.cells_of_block(slot);
    if (block_cells.empty()) return;
    const BlockCrossings crossings(block, field.grid(), block_cells, primitives);
    for (const SurfaceCell& cell : block_cells) {
      const EdgeMask crossed = crossed_edges(cell.signs);
      for (int edge = 0; edge < k_cell_edges; ++edge) {
        if (((crossed >> edge) & 1) == 0) continue;
        const Crossing& crossing = crossings.at(cell, edge);
        contour.quadrics[cell.first_vertex + static_cast<std::uint32_t>(cell.loops.loop_of(edge))].add(crossing.point,
                                                                                                       crossing.normal);
      }
    }
    for (const Crossing& crossing : crossings.all()) {
      if (owns(block, crossing.corner)) contour.quads[slot].push_back(quad_around(crossing, cells));
    }
  });
  return contour;
}

}  // namespace cloud2csg
