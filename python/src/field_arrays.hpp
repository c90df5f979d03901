#pragma once

#include <functional>
#include <vector>

#include "arrays.hpp"
#include "run_work.hpp"

/// Fields at the points of NumPy arrays: block by block, on the threads of the run, straight into the result. No copy
/// of all points is made.
namespace cloud2csg::python {

/// One value a point: shape (n,). @throws ValueError as PointArray
[[nodiscard]] pybind11::array_t<double> distances_at(const pybind11::object& points, const RunArguments& arguments,
                                                     const std::function<std::vector<double>(PointsView)>& field);

/// One vector a point: shape (n, 3). @throws ValueError as PointArray
[[nodiscard]] pybind11::array_t<double> gradients_at(const pybind11::object& points, const RunArguments& arguments,
                                                     const std::function<Points(PointsView)>& field);

}  // namespace cloud2csg::python
