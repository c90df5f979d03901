#include "fitness/point_blocks.hpp"

#include <numeric>

namespace cloud2csg {
namespace {

/// Cells along an axis, a power of two: with a chunk of points on a surface, some tens in a cell.
constexpr int k_bits = 3;
constexpr int k_side = 1 << k_bits;
constexpr std::size_t k_cells = std::size_t{k_side} * k_side * k_side;

/// Spreads k_bits bits three apart.
constexpr std::array<std::uint16_t, k_side> k_spread = [] {
  std::array<std::uint16_t, k_side> spread{};
  for (unsigned value = 0; value < k_side; ++value) {
    for (unsigned bit = 0; bit < k_bits; ++bit) {
      spread[value] = static_cast<std::uint16_t>(spread[value] | (value >> bit & 1U) << (3 * bit));
    }
  }
  return spread;
}();

std::uint16_t spread_step(double offset, double cells_a_unit) {
  // The lower bound first: whatever the number, the result is an index.
  return k_spread[static_cast<std::size_t>(std::min(std::max(0.0, offset * cells_a_unit), k_side - 1.0))];
}

}  // namespace

template <class Real>
PointBlocks<Real>::PointBlocks(const PointCloud& cloud, const AlignedBox& box)
    : cloud_(&cloud),
      corner_(box.min()),
      cells_a_unit_(k_side / std::max(box.sizes().maxCoeff(), 1e-300)),
      origin_(origin(box)),
      columns_(std::make_unique<std::array<Column, 6>>()) {}

template <class Real>
Eigen::Vector3d PointBlocks<Real>::origin(const AlignedBox& box) {
  return sizeof(Real) < sizeof(double) ? Eigen::Vector3d(box.center()) : Eigen::Vector3d::Zero();
}

template <class Real>
std::uint16_t PointBlocks<Real>::cell_of(double x, double y, double z) const {
  return static_cast<std::uint16_t>(spread_step(x - corner_.x(), cells_a_unit_) |
                                    spread_step(y - corner_.y(), cells_a_unit_) << 1U |
                                    spread_step(z - corner_.z(), cells_a_unit_) << 2U);
}

template <class Real>
void PointBlocks<Real>::load(std::size_t chunk) {
  const std::size_t begin = chunk * k_chunk_points;
  points_ = std::min(k_chunk_points, cloud_->size() - begin);
  const PointsView positions = cloud_->positions.view().subview(begin, points_);
  const PointsView normals = cloud_->normals.view().subview(begin, points_);
  std::array<std::uint32_t, k_cells> places{};
  for (std::size_t i = 0; i < points_; ++i) {
    cells_[i] = cell_of(positions.x[i], positions.y[i], positions.z[i]);
    ++places[cells_[i]];
  }
  std::exclusive_scan(places.begin(), places.end(), places.begin(), 0U);
  std::array<Column, 6>& columns = *columns_;
  for (std::size_t i = 0; i < points_; ++i) {
    const std::uint32_t place = places[cells_[i]]++;
    columns[0].values[place] = static_cast<Real>(positions.x[i] - origin_.x());
    columns[1].values[place] = static_cast<Real>(positions.y[i] - origin_.y());
    columns[2].values[place] = static_cast<Real>(positions.z[i] - origin_.z());
    columns[3].values[place] = static_cast<Real>(normals.x[i]);
    columns[4].values[place] = static_cast<Real>(normals.y[i]);
    columns[5].values[place] = static_cast<Real>(normals.z[i]);
  }
  for (Column& column : columns) {
    const auto end = static_cast<std::ptrdiff_t>(count() * k_block_points);
    std::fill(column.values.begin() + static_cast<std::ptrdiff_t>(points_), column.values.begin() + end,
              column.values[points_ - 1]);
  }
}

template class PointBlocks<double>;
template class PointBlocks<float>;

}  // namespace cloud2csg
