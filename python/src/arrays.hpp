#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "cloud2csg/geometry.hpp"

/// Conversion of NumPy arrays. Arrays are (n, 3) in Python; the library has one column per coordinate.
namespace cloud2csg::python {

/// Points of shape (n, 3). float64 arrays of any layout are not copied; float32, integers and lists are converted.
class PointArray {
 public:
  /// `name` is the argument's name in messages.
  /// @throws ValueError for another shape, values that are not numbers, NaN and infinity.
  PointArray(const pybind11::handle& values, const std::string& name);

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(array_.shape(0)); }
  /// Copies columns; does not need the interpreter's lock.
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

/// A C-contiguous copy of shape (n, 3).
[[nodiscard]] pybind11::array_t<double> to_rows(PointsView points);

/// Writes points to rows first, first + 1... of an array of shape (n, 3) in C order.
void fill_rows(PointsView points, std::span<double> rows, std::size_t first);

/// Read-only views of memory of `owner`, which they keep alive.
[[nodiscard]] pybind11::array view(std::span<const double> values, const pybind11::handle& owner);
[[nodiscard]] pybind11::array view(std::span<const std::uint32_t> values, const pybind11::handle& owner);
/// One view per coordinate.
[[nodiscard]] pybind11::tuple column_views(PointsView points, const pybind11::handle& owner);

pybind11::array read_only(pybind11::array array);

/// [[min x, y, z], [max x, y, z]]: shape (2, 3).
[[nodiscard]] pybind11::array_t<double> to_array(const AlignedBox& box);

}  // namespace cloud2csg::python
