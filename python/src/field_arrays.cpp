#include "field_arrays.hpp"

#include <algorithm>

#include "core/base/parallel.hpp"

namespace cloud2csg::python {
namespace {

namespace py = pybind11;

/// Large enough to amortise a tree's set-up, small enough for all cores and for Ctrl-C.
constexpr std::size_t k_block = 16'384;

/// Calls work(points of a block, index of its first one).
template <typename Work>
void for_each_block(const PointArray& points, const RunArguments& arguments, const Work& work) {
  run_on_thread(arguments, [&](const RunContext& run) {
    for_each_index((points.size() + k_block - 1) / k_block, run, [&](std::size_t block) {
      const std::size_t first = block * k_block;
      work(points.columns(first, std::min(k_block, points.size() - first)), first);
    });
  });
}

}  // namespace

py::array_t<double> distances_at(const py::object& points, const RunArguments& arguments,
                                 const std::function<std::vector<double>(PointsView)>& field) {
  const PointArray places(points, "points");
  py::array_t<double> result(static_cast<py::ssize_t>(places.size()));
  double* const out = result.mutable_data();
  for_each_block(places, arguments, [&](const Points& block, std::size_t first) {
    const std::vector<double> values = field(block);
    std::copy(values.begin(), values.end(), out + first);
  });
  return result;
}

py::array_t<double> gradients_at(const py::object& points, const RunArguments& arguments,
                                 const std::function<Points(PointsView)>& field) {
  const PointArray places(points, "points");
  py::array_t<double> result(std::vector<py::ssize_t>{static_cast<py::ssize_t>(places.size()), 3});
  const std::span<double> out(result.mutable_data(), 3 * places.size());
  for_each_block(places, arguments,
                 [&](const Points& block, std::size_t first) { fill_rows(field(block), out, first); });
  return result;
}

}  // namespace cloud2csg::python
