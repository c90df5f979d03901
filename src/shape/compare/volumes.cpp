#include "shape/compare/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/boxes.hpp"
#include "shape/compare/column_grid.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_chunk_columns = 1024;

/// Bounds of a shape that has a volume; empty when it has none.
AlignedBox volume_bounds(const Shape3d& shape) {
  if (shape.mesh) return bounds_of(shape.mesh->vertices.view());
  if (!shape.model) return {};
  const AlignedBox box = bounds_of(*shape.model);
  if (!box.isEmpty() && !is_finite(box)) {
    throw Error({.where = "tree",
                 .expected = "the solid is unbounded: it has no volume",
                 .remedy = "intersect it with a bounded primitive such as a box"});
  }
  return box;
}

/// Either kind of solid, cut by the columns of a grid.
class SolidColumns {
 public:
  SolidColumns(const Shape3d& shape, const ColumnGrid& grid, const RunContext& run) {
    if (shape.model) model_.emplace(*shape.model, grid);
    if (shape.mesh) mesh_.emplace(*shape.mesh, grid, run);
    // A column may graze an edge and count one triangle too many or too few; a hole leaves many open.
    constexpr double k_tolerated_share = 1e-3;
    has_volume_ = model_ || (mesh_ && static_cast<double>(mesh_->open_columns()) <=
                                          k_tolerated_share * static_cast<double>(grid.size()));
  }

  [[nodiscard]] bool has_volume() const { return has_volume_; }
  [[nodiscard]] ColumnCuts cuts(std::size_t first, std::size_t count) const {
    return model_ ? model_->cuts(first, count) : mesh_->cuts(first, count);
  }

 private:
  std::optional<ModelColumns> model_;
  std::optional<MeshColumns> mesh_;
  bool has_volume_ = false;
};

double total_length(std::span<const double> cuts) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) length += cuts[i + 1] - cuts[i];
  return length;
}

double common_length(std::span<const double> a, std::span<const double> b) {
  double length = 0.0;
  for (std::size_t i = 0, j = 0; i + 1 < a.size() && j + 1 < b.size();) {
    const double from = std::max(a[i], b[j]);
    const double to = std::min(a[i + 1], b[j + 1]);
    if (to > from) length += to - from;
    (a[i + 1] < b[j + 1] ? i : j) += 2;
  }
  return length;
}

struct Lengths {
  double truth = 0.0, result = 0.0, common = 0.0;
};

Lengths measure_chunk(const SolidColumns& truth, const SolidColumns& result, std::size_t first, std::size_t count) {
  const ColumnCuts truth_cuts = truth.has_volume() ? truth.cuts(first, count) : ColumnCuts{};
  const ColumnCuts result_cuts = result.has_volume() ? result.cuts(first, count) : ColumnCuts{};
  Lengths lengths;
  for (std::size_t column = 0; column < count; ++column) {
    if (truth.has_volume()) lengths.truth += total_length(truth_cuts.of(column));
    if (result.has_volume()) lengths.result += total_length(result_cuts.of(column));
    if (truth.has_volume() && result.has_volume()) {
      lengths.common += common_length(truth_cuts.of(column), result_cuts.of(column));
    }
  }
  return lengths;
}

}  // namespace

Volumes measure_volumes(const Shape3d& truth, const Shape3d& result, int resolution, const RunContext& run) {
  AlignedBox box = volume_bounds(truth);
  box.extend(volume_bounds(result));
  Volumes volumes;
  if (box.isEmpty() || box.sizes().maxCoeff() <= 0.0) return volumes;
  const ColumnGrid grid(box, resolution);
  const SolidColumns truth_columns(truth, grid, run);
  const SolidColumns result_columns(result, grid, run);

  std::vector<Lengths> chunks((grid.size() + k_chunk_columns - 1) / k_chunk_columns);
  for_each_index(chunks.size(), run, [&](std::size_t i) {
    const std::size_t first = i * k_chunk_columns;
    chunks[i] = measure_chunk(truth_columns, result_columns, first, std::min(k_chunk_columns, grid.size() - first));
  });
  Lengths sum;
  for (const Lengths& chunk : chunks) {
    sum.truth += chunk.truth;
    sum.result += chunk.result;
    sum.common += chunk.common;
  }
  const double area = grid.spacing() * grid.spacing();
  if (truth_columns.has_volume()) volumes.truth = sum.truth * area;
  if (result_columns.has_volume()) volumes.result = sum.result * area;
  if (truth_columns.has_volume() && result_columns.has_volume()) volumes.common = sum.common * area;
  return volumes;
}

}  // namespace cloud2csg
