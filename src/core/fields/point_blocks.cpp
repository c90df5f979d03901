#include "core/fields/point_blocks.hpp"

#include <algorithm>
#include <type_traits>

namespace cloud2csg {
namespace {

/// Single precision rounds to 6e-8 of the largest length involved: a five-thousandth of this.
constexpr double k_single_precision_noise = 3e-4;

/// Whether its pose may move along its plane, which changes rounding but not the solid.
bool is_plain_half_space(const Primitive& primitive) {
  return std::holds_alternative<HalfSpace>(primitive.shape) && !primitive.displacement;
}

Eigen::Vector3d foot_of_origin(const Pose& pose) {
  const Eigen::Vector3d normal = pose.orientation * Eigen::Vector3d::UnitZ();
  return normal * normal.dot(pose.position);
}

/// The largest length in the computation of a primitive's distances, seen from `centre`.
double reach_from(const Eigen::Vector3d& centre, const Primitive& primitive) {
  Pose pose = primitive.pose;
  pose.position -= centre;
  if (is_plain_half_space(primitive)) return foot_of_origin(pose).norm();
  // For a displaced solid its plain size will do: the search for its real reach takes longer than the rest.
  Primitive plain = primitive;
  plain.displacement.reset();
  const Eigen::Vector3d half_size = oriented_bounds(plain).half_size;
  return pose.position.norm() + (half_size.allFinite() ? 2 * half_size.norm() : 0.0);
}

/// Bounds of rows `begin` to `end` of columns x, y and z.
template <class Columns>
AlignedBox bounds_of_rows(const Columns& columns, std::size_t begin, std::size_t end) {
  AlignedBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& values = columns[static_cast<std::size_t>(axis)].values;
    using Row = Eigen::Array<typename std::decay_t<decltype(values)>::value_type, Eigen::Dynamic, 1>;
    const Eigen::Map<const Row> rows(&values[begin], static_cast<Eigen::Index>(end - begin));
    box.min()[axis] = static_cast<double>(rows.minCoeff());
    box.max()[axis] = static_cast<double>(rows.maxCoeff());
  }
  return box;
}

}  // namespace

bool is_single_enough(const AlignedBox& points, const PrimitiveSet& primitives, double noise) {
  double length = points.diagonal().norm();
  for (const Primitive& primitive : primitives) length = std::max(length, reach_from(points.center(), primitive));
  return noise >= k_single_precision_noise * length;
}

template <class Real>
void move_to_frame(PrimitiveSet& primitives, const Eigen::Vector3d& origin) {
  for (Primitive& primitive : primitives) {
    primitive.pose.position -= origin;
    if (sizeof(Real) < sizeof(double) && is_plain_half_space(primitive)) {
      primitive.pose.position = foot_of_origin(primitive.pose);
    }
  }
}

template void move_to_frame<double>(PrimitiveSet&, const Eigen::Vector3d&);
template void move_to_frame<float>(PrimitiveSet&, const Eigen::Vector3d&);

template <class Real>
PointBlocks<Real>::PointBlocks(const PointCloud& cloud, const AlignedBox& box, std::span<const std::uint32_t> order)
    : cloud_(&cloud), order_(order), origin_(origin(box)), columns_(std::make_unique<std::array<Column, 6>>()) {}

template <class Real>
Eigen::Vector3d PointBlocks<Real>::origin(const AlignedBox& box) {
  return sizeof(Real) < sizeof(double) ? Eigen::Vector3d(box.center()) : Eigen::Vector3d::Zero();
}

template <class Real>
AlignedBox PointBlocks<Real>::bounds(std::size_t block) const {
  const std::size_t begin = block * k_block_points;
  return bounds_of_rows(*columns_, begin, begin + size(block));
}

template <class Real>
AlignedBox PointBlocks<Real>::bounds() const {
  return bounds_of_rows(*columns_, 0, points_);
}

template <class Real>
void PointBlocks<Real>::load(std::size_t chunk) {
  begin_ = chunk * k_chunk_points;
  points_ = std::min(k_chunk_points, cloud_->size() - begin_);
  take_column(0, cloud_->positions.x, origin_.x());
  take_column(1, cloud_->positions.y, origin_.y());
  take_column(2, cloud_->positions.z, origin_.z());
  take_column(3, cloud_->normals.x, 0);
  take_column(4, cloud_->normals.y, 0);
  take_column(5, cloud_->normals.z, 0);
}

template <class Real>
void PointBlocks<Real>::take_column(std::size_t which, const std::vector<double>& from, double origin) {
  auto& values = (*columns_)[which].values;
  const std::span<const std::uint32_t> sources = order_.subspan(begin_, points_);
  for (std::size_t i = 0; i < points_; ++i) values[i] = static_cast<Real>(from[sources[i]] - origin);
  const auto end = static_cast<std::ptrdiff_t>(count() * k_block_points);
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(points_), values.begin() + end, values[points_ - 1]);
}

template class PointBlocks<double>;
template class PointBlocks<float>;

}  // namespace cloud2csg
