#include "arrays.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace cloud2csg::python {
namespace {

namespace py = pybind11;

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

template <typename Number>
py::array view_of(std::span<const Number> values, const py::handle& owner) {
  return read_only(py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}

}  // namespace

PointArray::PointArray(const py::handle& values, const std::string& name) : array_(Array::ensure(values)) {
  if (!array_) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{}: expected numbers in an array of shape (n, 3)", name));
  }
  if (array_.ndim() != 2 || array_.shape(1) != 3) {
    throw py::value_error(
        fmt::format("{}: expected an array of shape (n, 3), found one of shape {}", name, shape_text(array_)));
  }
  data_ = static_cast<const char*>(static_cast<const py::array&>(array_).data());
  row_stride_ = array_.strides(0);
  column_stride_ = array_.strides(1);
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::isfinite(at(i, 0)) && std::isfinite(at(i, 1)) && std::isfinite(at(i, 2))) continue;
    throw py::value_error(fmt::format("{}: expected finite numbers, found ({}, {}, {}) in row {}", name, at(i, 0),
                                      at(i, 1), at(i, 2), i));
  }
}

Points PointArray::columns(std::size_t first, std::size_t count) const {
  Points points(count);
  for (std::size_t i = 0; i < count; ++i) {
    points.x[i] = at(first + i, 0);
    points.y[i] = at(first + i, 1);
    points.z[i] = at(first + i, 2);
  }
  return points;
}

void fill_rows(PointsView points, std::span<double> rows, std::size_t first) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    rows[3 * (first + i)] = points.x[i];
    rows[3 * (first + i) + 1] = points.y[i];
    rows[3 * (first + i) + 2] = points.z[i];
  }
}

py::array_t<double> to_rows(PointsView points) {
  const auto rows = static_cast<py::ssize_t>(points.size());
  py::array_t<double> array(std::vector<py::ssize_t>{rows, 3});
  fill_rows(points, {array.mutable_data(), 3 * points.size()}, 0);
  return array;
}

py::array read_only(py::array array) {
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::array view(std::span<const double> values, const py::handle& owner) {
  return view_of(values, owner);
}

py::array view(std::span<const std::uint32_t> values, const py::handle& owner) {
  return view_of(values, owner);
}

py::tuple column_views(PointsView points, const py::handle& owner) {
  return py::make_tuple(view(points.x, owner), view(points.y, owner), view(points.z, owner));
}

py::array_t<double> to_array(const AlignedBox& box) {
  Points corners;
  corners.push_back(box.min());
  corners.push_back(box.max());
  return to_rows(corners);
}

}  // namespace cloud2csg::python
