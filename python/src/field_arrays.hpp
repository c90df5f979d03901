#pragma once

#include <functional>
#include <vector>

#include "arrays.hpp"
#include "run_work.hpp"

/// Fields at the points of NumPy arrays, block by block and in parallel, without a copy of all points.
namespace cloud2csg::python {

/// One value per point: shape (n,). @throws ValueError as PointArray
[[nodiscard]] pybind11::array_t<double> distances_at(const pybind11::object& points, const RunArguments& arguments,
                                                     const std::function<std::vector<double>(PointsView)>& field);

/// One vector per point: shape (n, 3). @throws ValueError as PointArray
[[nodiscard]] pybind11::array_t<double> gradients_at(const pybind11::object& points, const RunArguments& arguments,
                                                     const std::function<Points(PointsView)>& field);

}  // namespace cloud2csg::python
