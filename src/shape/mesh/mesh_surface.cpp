#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "core/base/parallel.hpp"
#include "shape/mesh/contour.hpp"

namespace cloud2csg {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Cuts quads along the diagonal that follows the surface, as a sharp edge. `positions`: vertices in grid coordinates.
class QuadCutter {
 public:
  QuadCutter(const Grid& grid, const CsgTree& tree, const PrimitiveSet& primitives,
             std::span<const Eigen::Vector3d> positions)
      : grid_(grid), tree_(tree), primitives_(primitives), positions_(positions) {}

  struct Result {
    std::vector<Triangle> triangles;
    std::vector<Triangle> folded;  ///< those that face the wrong way
  };
  [[nodiscard]] Result cut(std::span<const Quad> quads) const;

 private:
  /// The two triangles at the diagonal from corner 0 (or 1) of a quad.
  struct Cut {
    std::array<Triangle, 2> triangles;
    std::array<Eigen::Vector3d, 2> normals;  ///< unit length; zero for a triangle without area
  };

  [[nodiscard]] Cut cut_from(const Quad& quad, std::size_t start) const;
  [[nodiscard]] Eigen::Vector3d normal_of(const Triangle& triangle) const;
  [[nodiscard]] Eigen::Vector3d centroid_of(const Triangle& triangle) const;
  [[nodiscard]] double squared_diagonal(const Quad& quad, std::size_t start) const;
  [[nodiscard]] std::vector<double> alignments(std::span<const Cut> cuts) const;
  [[nodiscard]] bool is_flat(const std::array<Cut, 2>& cuts) const;

  const Grid& grid_;
  const CsgTree& tree_;
  const PrimitiveSet& primitives_;
  std::span<const Eigen::Vector3d> positions_;
};

// Least cosine between the triangles of a flat quad, for which either diagonal will do.
constexpr double k_flat = 0.99;
// Twice the area, in cells, below which a triangle counts as degenerate.
constexpr double k_no_area = 1e-6;
// Alignment of a degenerate triangle: below any cosine.
constexpr double k_without_area = -2.0;
// Difference of alignment below which the shorter diagonal decides.
constexpr double k_same = 1e-6;

QuadCutter::Result QuadCutter::cut(std::span<const Quad> quads) const {
  Result result;
  result.triangles.reserve(2 * quads.size());
  const auto keep = [&result](const Cut& cut) {
    result.triangles.insert(result.triangles.end(), cut.triangles.begin(), cut.triangles.end());
  };
  std::vector<Cut> doubtful;        // two a quad
  std::vector<bool> prefers_first;  // by length, for doubtful quads
  for (const Quad& quad : quads) {
    const std::array<Cut, 2> cuts{cut_from(quad, 0), cut_from(quad, 1)};
    const bool first_is_shorter = squared_diagonal(quad, 0) <= squared_diagonal(quad, 1);
    if (is_flat(cuts)) {
      keep(cuts[first_is_shorter ? 0 : 1]);
    } else {
      doubtful.insert(doubtful.end(), cuts.begin(), cuts.end());
      prefers_first.push_back(first_is_shorter);
    }
  }
  const std::vector<double> aligned = alignments(doubtful);
  const auto worse = [&aligned](std::size_t cut) { return std::min(aligned[2 * cut], aligned[2 * cut + 1]); };
  for (std::size_t i = 0; i < prefers_first.size(); ++i) {
    const double gain = worse(2 * i) - worse(2 * i + 1);
    const bool first = std::abs(gain) > k_same ? gain > 0 : static_cast<bool>(prefers_first[i]);
    const std::size_t better = 2 * i + (first ? 0 : 1);
    keep(doubtful[better]);
    for (std::size_t k = 0; k < 2; ++k) {
      const double alignment = aligned[2 * better + k];
      if (alignment < 0 && alignment > k_without_area) result.folded.push_back(doubtful[better].triangles[k]);
    }
  }
  return result;
}

bool QuadCutter::is_flat(const std::array<Cut, 2>& cuts) const {
  const Eigen::Vector3d& normal = cuts[0].normals[0];
  const auto agrees = [&normal](const Eigen::Vector3d& other) { return normal.dot(other) > k_flat; };
  return agrees(cuts[0].normals[1]) && agrees(cuts[1].normals[0]) && agrees(cuts[1].normals[1]);
}

QuadCutter::Cut QuadCutter::cut_from(const Quad& quad, std::size_t start) const {
  const auto& v = quad.vertices;
  Cut cut{.triangles = {{{v[start], v[start + 1], v[start + 2]}, {v[start], v[start + 2], v[(start + 3) % 4]}}},
          .normals = {}};
  for (std::size_t i = 0; i < 2; ++i) cut.normals[i] = normal_of(cut.triangles[i]);
  return cut;
}

Eigen::Vector3d QuadCutter::normal_of(const Triangle& triangle) const {
  const Eigen::Vector3d& a = positions_[triangle[0]];
  const Eigen::Vector3d normal = (positions_[triangle[1]] - a).cross(positions_[triangle[2]] - a);
  const double length = normal.norm();
  return length > k_no_area ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
}

Eigen::Vector3d QuadCutter::centroid_of(const Triangle& triangle) const {
  return (positions_[triangle[0]] + positions_[triangle[1]] + positions_[triangle[2]]) / 3.0;
}

double QuadCutter::squared_diagonal(const Quad& quad, std::size_t start) const {
  return (positions_[quad.vertices[start + 2]] - positions_[quad.vertices[start]]).squaredNorm();
}

/// For each triangle of each cut, the cosine between its normal and the surface's.
std::vector<double> QuadCutter::alignments(std::span<const Cut> cuts) const {
  Points centroids;
  for (const Cut& cut : cuts) {
    for (const Triangle& triangle : cut.triangles) centroids.push_back(grid_.to_world(centroid_of(triangle)));
  }
  const Points gradients = implicit_gradient(tree_, primitives_, centroids);
  std::vector<double> result;
  result.reserve(2 * cuts.size());
  for (const Cut& cut : cuts) {
    for (const Eigen::Vector3d& normal : cut.normals) {
      const Eigen::Vector3d gradient = gradients[result.size()];
      result.push_back(normal.isZero() ? k_without_area : normal.dot(gradient.stableNormalized()));
    }
  }
  return result;
}

struct Untangled {
  std::vector<Eigen::Vector3d> positions;  ///< by vertex, in grid coordinates
  std::vector<Triangle> triangles;
};

/// Demotes the triangle's vertices of the weakest kind below `limit`; false if there are none.
bool relax(const Triangle& triangle, const Contour& contour, VertexKind limit, Placement& placement,
           std::vector<bool>& moved) {
  VertexKind weakest = limit;
  for (const std::uint32_t vertex : triangle) weakest = std::min(weakest, placement.kinds[vertex]);
  if (weakest == limit) return false;
  for (const std::uint32_t vertex : triangle) {
    if (placement.kinds[vertex] != weakest) continue;
    const bool to_mean = weakest == VertexKind::in_cell || placement.positions[vertex] == placement.in_cell[vertex];
    placement.positions[vertex] = to_mean ? contour.quadrics[vertex].mean_point() : placement.in_cell[vertex];
    placement.kinds[vertex] = to_mean ? VertexKind::mean : VertexKind::in_cell;
    moved[vertex] = true;
  }
  return true;
}

bool touches(std::span<const Quad> quads, const std::vector<bool>& moved) {
  return std::any_of(quads.begin(), quads.end(), [&moved](const Quad& quad) {
    return std::any_of(quad.vertices.begin(), quad.vertices.end(), [&moved](std::uint32_t v) { return moved[v]; });
  });
}

/// Cuts all quads into triangles. Where vertices on sharp edges overtake each other and fold a triangle, they retreat:
/// from the edge into their cells, then to the mean of their crossings, until no triangle is folded or none can
/// retreat. Vertices at corners of the solid retreat last, or never if `corners_first`. @throws Cancelled
Untangled cut_untangled(const SparseField& field, const PrimitiveSet& primitives, const Contour& contour,
                        Placement placement, bool corners_first, const RunContext& run) {
  constexpr int k_most_rounds = 8;
  const VertexKind limit = corners_first ? VertexKind::corner : VertexKind::mean;
  std::vector<QuadCutter::Result> cuts(field.blocks().size());
  std::vector<bool> moved(placement.positions.size(), true);
  for (int round = 0; round < k_most_rounds; ++round) {
    for_each_index(cuts.size(), run, [&](std::size_t slot) {
      if (!touches(contour.quads[slot], moved)) return;
      const QuadCutter cutter(field.grid(), field.blocks()[slot].tree, primitives, placement.positions);
      cuts[slot] = cutter.cut(contour.quads[slot]);
    });
    std::fill(moved.begin(), moved.end(), false);
    bool any = false;
    for (const QuadCutter::Result& cut : cuts) {
      for (const Triangle& triangle : cut.folded) any = relax(triangle, contour, limit, placement, moved) || any;
    }
    if (!any) break;
  }
  Untangled result{.positions = std::move(placement.positions), .triangles = {}};
  for (const QuadCutter::Result& cut : cuts) {
    result.triangles.insert(result.triangles.end(), cut.triangles.begin(), cut.triangles.end());
  }
  return result;
}

}  // namespace

TriangleMesh mesh_surface(const Model& model, const AlignedBox& bounds, const MeshingOptions& options,
                          const RunContext& run) {
  constexpr std::size_t k_steps = 4;
  validate(options);
  const BoundedSolid solid = bound_solid(model, bounds);
  if (solid.bounds.isEmpty()) return {};
  run.report("mesh", 0, k_steps);
  const SparseField field(solid, options.resolution, run);
  const SurfaceCells cells(field, solid);
  run.report("mesh", 1, k_steps);
  const Contour contour = trace_contour(field, cells, solid.primitives, run);
  run.report("mesh", 2, k_steps);
  Placement placement = place_vertices(field, cells, solid.primitives, contour, run);
  run.report("mesh", 3, k_steps);
  TriangleMesh mesh;
  Untangled cut = cut_untangled(field, solid.primitives, contour, std::move(placement), options.corners_first, run);
  mesh.triangles = std::move(cut.triangles);
  mesh.vertices.reserve(cut.positions.size());
  for (const Eigen::Vector3d& position : cut.positions) mesh.vertices.push_back(field.grid().to_world(position));
  run.report("mesh", k_steps, k_steps);
  return mesh;
}

}  // namespace cloud2csg
