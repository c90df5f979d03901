#pragma once

#include <array>
#include <cstddef>

#include "paper/objective/point_kernels.hpp"

/// Input of the kernels that work on blocks of points.
namespace cloud2csg::test {

template <class Real>
struct alignas(64) Column {
  std::array<Real, k_block_points> values{};
};

/// A field, and normals.
template <class Real>
struct FieldBlock {
  BlockField<Real> field;
  std::array<Column<Real>, 3> normal_columns;

  [[nodiscard]] BlockNormals<Real> normals() const {
    return {normal_columns[0].values.data(), normal_columns[1].values.data(), normal_columns[2].values.data()};
  }
  void set_normal(std::size_t i, const Eigen::Vector3d& normal) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      normal_columns[axis].values[i] = static_cast<Real>(normal[static_cast<Eigen::Index>(axis)]);
    }
  }
  void set_gradient(std::size_t i, const Eigen::Vector3d& slope) {
    field.gradient_x[i] = static_cast<Real>(slope.x());
    field.gradient_y[i] = static_cast<Real>(slope.y());
    field.gradient_z[i] = static_cast<Real>(slope.z());
  }
};

}  // namespace cloud2csg::test
