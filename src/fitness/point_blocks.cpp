#include "fitness/point_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.hpp"

namespace cloud2csg {
namespace {

/// Spreads the lowest ten bits three apart.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16U) & 0x030000FFU;
  bits = (bits | bits << 8U) & 0x0300F00FU;
  bits = (bits | bits << 4U) & 0x030C30C3U;
  return (bits | bits << 2U) & 0x09249249U;
}

/// Cells of a cubic grid over the cloud's bounds, numbered along Morton's curve.
class CurveGrid {
 public:
  /// With some tens of points in a cell, if the cloud is a surface.
  CurveGrid(const AlignedBox& box, std::size_t points)
      : corner_(box.min()),
        bits_(std::clamp(static_cast<int>(std::bit_width(points / 128)) / 2, 1, 7)),
        cells_a_unit_(static_cast<double>(side()) / std::max(box.sizes().maxCoeff(), 1e-300)) {}

  [[nodiscard]] std::size_t cells() const { return std::size_t{1} << (3U * static_cast<unsigned>(bits_)); }
  [[nodiscard]] std::uint32_t cell_of(double x, double y, double z) const {
    return spread(step(x - corner_.x())) | spread(step(y - corner_.y())) << 1U | spread(step(z - corner_.z())) << 2U;
  }

 private:
  [[nodiscard]] int side() const { return 1 << bits_; }
  [[nodiscard]] std::uint32_t step(double offset) const {
    return static_cast<std::uint32_t>(std::min(static_cast<int>(offset * cells_a_unit_), side() - 1));
  }

  Eigen::Vector3d corner_;
  int bits_;
  double cells_a_unit_;
};

/// The parts of a cloud that threads work on.
struct Parts {
  std::size_t points, count;
  [[nodiscard]] std::size_t begin(std::size_t part) const { return points * part / count; }
};

/// For each part of the points and each cell, where the part's first point of the cell goes. Points of a cell keep
/// their order.
std::vector<std::vector<std::uint32_t>> first_places(const std::vector<std::uint32_t>& cells, const CurveGrid& grid,
                                                     const Parts& parts, const RunContext& run) {
  std::vector<std::vector<std::uint32_t>> places(parts.count);
  for_each_index(parts.count, run, [&](std::size_t part) {
    places[part].assign(grid.cells(), 0);
    for (std::size_t i = parts.begin(part); i < parts.begin(part + 1); ++i) ++places[part][cells[i]];
  });
  std::uint32_t next = 0;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    for (std::vector<std::uint32_t>& of_part : places) {
      const std::uint32_t count = of_part[cell];
      of_part[cell] = next;
      next += count;
    }
  }
  return places;
}

}  // namespace

template <class Real>
PointBlocks<Real>::PointBlocks(const PointCloud& cloud, const AlignedBox& box, const RunContext& run)
    : points_(cloud.size()), origin_(Eigen::Vector3d::Zero()) {
  if constexpr (sizeof(Real) < sizeof(double)) origin_ = box.center();
  for (auto& column : columns_) column = std::make_unique_for_overwrite<Column[]>(count());
  const CurveGrid grid(box, points_);
  const int threads = run.threads > 0 ? run.threads : usable_threads(run);
  const Parts parts{points_, std::clamp<std::size_t>(points_ >> 14U, 1, static_cast<std::size_t>(threads))};
  std::vector<std::uint32_t> cells(points_);
  const Points& p = cloud.positions;
  for_each_index(parts.count, run, [&](std::size_t part) {
    for (std::size_t i = parts.begin(part); i < parts.begin(part + 1); ++i)
      cells[i] = grid.cell_of(p.x[i], p.y[i], p.z[i]);
  });
  std::vector<std::vector<std::uint32_t>> places = first_places(cells, grid, parts, run);
  for_each_index(parts.count, run, [&](std::size_t part) {
    for (std::size_t i = parts.begin(part); i < parts.begin(part + 1); ++i) {
      const std::uint32_t place = places[part][cells[i]]++;
      at(0, place) = static_cast<Real>(p.x[i] - origin_.x());
      at(1, place) = static_cast<Real>(p.y[i] - origin_.y());
      at(2, place) = static_cast<Real>(p.z[i] - origin_.z());
      at(3, place) = static_cast<Real>(cloud.normals.x[i]);
      at(4, place) = static_cast<Real>(cloud.normals.y[i]);
      at(5, place) = static_cast<Real>(cloud.normals.z[i]);
    }
  });
  for (std::size_t column = 0; column < columns_.size(); ++column) {
    for (std::size_t place = points_; place < count() * k_block_points; ++place)
      at(column, place) = at(column, points_ - 1);
  }
}

template class PointBlocks<double>;
template class PointBlocks<float>;

}  // namespace cloud2csg
