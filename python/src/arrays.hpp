#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "cloud2csg/geometry.hpp"

/// NumPy arrays in and out. Arrays are (n, 3) in Python; the library has a column for each coordinate.
namespace cloud2csg::python {

/// Points as a NumPy array of shape (n, 3), float64, in any layout: arrays that are so are used as they are, others
/// (float32, integers, lists) are converted.
class PointArray {
 public:
  /// `name` stands for the argument in messages.
  /// @throws ValueError for another shape, for what are no numbers, and for NaN and infinity.
  PointArray(const pybind11::handle& values, const std::string& name);

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(array_.shape(0)); }
  /// Columns of our own. The interpreter's lock is not needed.
  [[nodiscard]] Points columns(std::size_t first, std::size_t count) const;
  [[nodiscard]] Points columns() const { return columns(0, size()); }

 private:
  static constexpr int k_aligned = 0x0100;  // NPY_ARRAY_ALIGNED
  using Array = pybind11::array_t<double, pybind11::array::forcecast | k_aligned>;
  [[nodiscard]] double at(std::size_t row, int column) const {
    return *reinterpret_cast<const double*>(data_ + static_cast<pybind11::ssize_t>(row) * row_stride_ +
                                            column * column_stride_);
  }
  Array array_;
  const char* data_ = nullptr;
  pybind11::ssize_t row_stride_ = 0, column_stride_ = 0;  ///< in bytes
};

/// A copy of shape (n, 3), C-contiguous.
[[nodiscard]] pybind11::array_t<double> to_rows(PointsView points);

/// Writes points to rows first, first + 1... of an array of shape (n, 3) in C order.
void fill_rows(PointsView points, std::span<double> rows, std::size_t first);

/// Views of memory that belongs to `owner`, which they keep alive: read-only, no copies.
[[nodiscard]] pybind11::array view(std::span<const double> values, const pybind11::handle& owner);
[[nodiscard]] pybind11::array view(std::span<const std::uint32_t> values, const pybind11::handle& owner);
/// The three coordinates, a view each.
[[nodiscard]] pybind11::tuple column_views(PointsView points, const pybind11::handle& owner);

/// Makes an array read-only.
pybind11::array read_only(pybind11::array array);

/// [[min x, y, z], [max x, y, z]]: shape (2, 3).
[[nodiscard]] pybind11::array_t<double> to_array(const AlignedBox& box);

}  // namespace cloud2csg::python
