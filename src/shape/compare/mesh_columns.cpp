#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shape/compare/column_grid.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

struct Crossing {
  std::int32_t column;
  std::int32_t direction;  ///< by the triangle's winding: 1 into the solid, -1 out of it
  double depth;

  friend bool operator<(const Crossing& a, const Crossing& b) {
    return a.column < b.column || (a.column == b.column && a.depth < b.depth);
  }
};

/// Twice the area of (a, b, node), positive when counter-clockwise. Computed from the smaller end, so both triangles at
/// an edge get the same number and no column slips between them.
double edge_side(const Vector3d& a, const Vector3d& b, double u, double v) {
  const bool swapped = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  const Vector3d& from = swapped ? b : a;
  const Vector3d& to = swapped ? a : b;
  double side = (to.x() - from.x()) * (v - from.y()) - (to.y() - from.y()) * (u - from.x());
  // A node on the edge counts as on its left.
  if (side == 0.0) side = std::numeric_limits<double>::min();
  return swapped ? -side : side;
}

void add_crossings(const std::array<Vector3d, 3>& triangle, const ColumnGrid& grid, std::vector<Crossing>& crossings) {
  const auto& [a, b, c] = triangle;
  const auto [u_low, u_high] = std::minmax({a.x(), b.x(), c.x()});
  const auto [v_low, v_high] = std::minmax({a.y(), b.y(), c.y()});
  const auto first = [](double low) { return std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(low))); };
  const auto last = [](double high, std::int64_t size) {
    return std::min(size - 1, static_cast<std::int64_t>(std::floor(high)));
  };
  for (std::int64_t j = first(v_low); j <= last(v_high, grid.height()); ++j) {
    for (std::int64_t i = first(u_low); i <= last(u_high, grid.width()); ++i) {
      const std::int32_t column = grid.column_at(i, j);
      if (column == ColumnGrid::k_no_column) continue;
      const auto u = static_cast<double>(i);
      const auto v = static_cast<double>(j);
      const double weight_c = edge_side(a, b, u, v);
      const double weight_a = edge_side(b, c, u, v);
      const double weight_b = edge_side(c, a, u, v);
      if ((weight_a > 0.0) != (weight_b > 0.0) || (weight_a > 0.0) != (weight_c > 0.0)) continue;
      const double sum = weight_a + weight_b + weight_c;
      const double depth = (weight_a * a.z() + weight_b * b.z() + weight_c * c.z()) / sum;
      // An outward triangle that is clockwise along the columns faces the viewer.
      crossings.push_back({.column = column, .direction = weight_a < 0.0 ? 1 : -1, .depth = depth});
    }
  }
}

}  // namespace

MeshColumns::MeshColumns(const TriangleMesh& mesh, const ColumnGrid& grid, const RunContext& run) {
  std::vector<Crossing> crossings;
  std::vector<Vector3d> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = grid.to_lattice(mesh.vertices[i]);
  constexpr std::size_t k_triangles_per_look = std::size_t{1} << 16;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % k_triangles_per_look == 0) run.throw_if_stopped();
    const auto& [a, b, c] = mesh.triangles[t];
    add_crossings({vertices[a], vertices[b], vertices[c]}, grid, crossings);
  }
  std::sort(crossings.begin(), crossings.end());

  const bool by_winding = is_watertight(mesh);
  std::size_t next = 0;
  for (std::size_t column = 0; column < grid.size(); ++column) {
    std::int32_t winding = 0;
    bool inside = false;
    for (; next < crossings.size() && static_cast<std::size_t>(crossings[next].column) == column; ++next) {
      winding += by_winding ? crossings[next].direction : 1;
      const bool now_inside = by_winding ? winding != 0 : winding % 2 != 0;
      if (now_inside != inside) all_.depths.push_back(crossings[next].depth);
      inside = now_inside;
    }
    if (inside) {
      all_.depths.pop_back();
      ++open_columns_;
    }
    all_.first.push_back(all_.depths.size());
  }
}

ColumnCuts MeshColumns::cuts(std::size_t first, std::size_t count) const {
  ColumnCuts part;
  for (std::size_t column = first; column < first + count; ++column) {
    const std::span<const double> depths = all_.of(column);
    part.depths.insert(part.depths.end(), depths.begin(), depths.end());
    part.first.push_back(part.depths.size());
  }
  return part;
}

}  // namespace cloud2csg
