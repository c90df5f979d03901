#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

/// Small types on top of Eigen: points as structure of arrays, rigid poses, boxes.
namespace cloud2csg {

/// A view of points or directions as structure of arrays: three spans of equal length. `Real` is double or float.
template <class Real>
struct BasicPointsView {
  std::span<const Real> x, y, z;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool empty() const { return x.empty(); }
  [[nodiscard]] Eigen::Vector3d operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  [[nodiscard]] BasicPointsView subview(std::size_t offset, std::size_t count) const {
    return {x.subspan(offset, count), y.subspan(offset, count), z.subspan(offset, count)};
  }
};
using PointsView = BasicPointsView<double>;

/// Points or directions as structure of arrays. Invariant: the three vectors have equal length.
struct Points {
  std::vector<double> x, y, z;

  Points() = default;
  explicit Points(std::size_t count) : x(count), y(count), z(count) {}

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool empty() const { return x.empty(); }
  [[nodiscard]] Eigen::Vector3d operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Eigen::Vector3d& p) { x[i] = p.x(), y[i] = p.y(), z[i] = p.z(); }
  void push_back(const Eigen::Vector3d& p) { x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()); }
  void reserve(std::size_t n) { x.reserve(n), y.reserve(n), z.reserve(n); }
  void resize(std::size_t n) { x.resize(n), y.resize(n), z.resize(n); }
  [[nodiscard]] PointsView view() const { return {x, y, z}; }
  operator PointsView() const { return view(); }  // NOLINT(google-explicit-constructor): a view is what it is
};

/// A rigid motion from a solid's local frame to the world: x_world = orientation * x_local + position.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< unit length

  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& local) const { return orientation * local + position; }
  [[nodiscard]] Eigen::Vector3d to_local(const Eigen::Vector3d& world) const {
    return orientation.conjugate() * (world - position);
  }
};

/// Applies `inner`, then `outer`: compose(a, b).to_world(x) == a.to_world(b.to_world(x)).
[[nodiscard]] Pose compose(const Pose& outer, const Pose& inner);

/// A pose at `position` whose local z axis is `axis` (any length but zero).
[[nodiscard]] Pose pose_from_axis(const Eigen::Vector3d& position, const Eigen::Vector3d& axis);

/// Axis-aligned box; may be infinite in some directions (half-spaces).
using AlignedBox = Eigen::AlignedBox3d;

/// A box in any orientation: |to_local(x)| <= half_size in each axis. May be infinite.
struct OrientedBox {
  Pose pose;
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();
};

/// The smallest axis-aligned box around an oriented one; infinite where the oriented one is.
[[nodiscard]] AlignedBox enclosing_box(const OrientedBox& box);

/// The axis-aligned bounds of points; empty for no points. O(n).
[[nodiscard]] AlignedBox bounds_of(PointsView points);

}  // namespace cloud2csg
