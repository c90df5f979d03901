#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <optional>

#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/compare.hpp"
#include "option_class.hpp"
#include "run_work.hpp"

namespace cloud2csg::python {
namespace {

Shape3d to_shape(const py::object& shape) {
  if (py::isinstance<Model>(shape)) return {.model = shape.cast<const Model&>()};
  if (py::isinstance<TriangleMesh>(shape)) return {.mesh = shape.cast<const TriangleMesh&>()};
  if (py::isinstance<Cloud>(shape)) return {.cloud = shape.cast<const Cloud&>().points()};
  if (py::hasattr(shape, "model")) return to_shape(shape.attr("model"));
  if (py::isinstance<py::str>(shape) || py::hasattr(shape, "__fspath__")) {
    const auto file = shape.cast<std::filesystem::path>();
    const py::gil_scoped_release unlocked;
    return read_shape(file);
  }
  throw py::type_error(
      fmt::format("compare: expected a Model, Result, TriangleMesh, PointCloud or the name of a file, found {}",
                  py::repr(shape).cast<std::string>()));
}

Comparison compare_shapes(const py::object& truth, const py::object& result,
                          const std::optional<CompareOptions>& options, int threads, const py::object& progress,
                          const py::kwargs& fields) {
  const CompareOptions comparing = with_fields(options, fields);
  const Shape3d first = to_shape(truth);
  const Shape3d second = to_shape(result);
  return run_work({.threads = threads, .progress = progress},
                  [&](const RunContext& run) { return compare(first, second, comparing, run); });
}

std::string number_text(const std::optional<double>& number) {
  return number ? fmt::format("{:.6g}", *number) : "None";
}

}  // namespace

void bind_compare(py::module_& module) {
  py::class_<Comparison>(module, "Comparison",
                         "Similarity of two solids. Values that the inputs do not allow (the volume of a cloud, the "
                         "tree of a mesh) are None.")
      .def_readonly("intersection_over_union", &Comparison::intersection_over_union,
                    "Intersection over union of the volumes; 1: equal.")
      .def_readonly("volume_truth", &Comparison::volume_truth, "Volume of the truth, in cubed units.")
      .def_readonly("volume_result", &Comparison::volume_result, "Volume of the result, in cubed units.")
      .def_readonly("mean_distance", &Comparison::mean_distance,
                    "Mean distance of each surface to the other one, averaged over both, in units of length.")
      .def_readonly("hausdorff_distance", &Comparison::hausdorff_distance,
                    "Largest distance from one surface to the other, in units of length.")
      .def_readonly("size_ratio", &Comparison::size_ratio, "Ratio of the numbers of tree nodes: result / truth.")
      .def_readonly("depth_ratio", &Comparison::depth_ratio, "Ratio of the tree depths: result / truth.")
      .def("__repr__", [](const Comparison& self) {
        return fmt::format(
            "Comparison(intersection_over_union={}, mean_distance={:.6g}, hausdorff_distance={:.6g}, size_ratio={})",
            number_text(self.intersection_over_union), self.mean_distance, self.hausdorff_distance,
            number_text(self.size_ratio));
      });
  module.def("compare", &compare_shapes, py::arg("truth"), py::arg("result"), py::arg("options") = py::none(),
             py::kw_only(), py::arg("threads") = 0, py::arg("progress") = py::none(),
             "Compares two shapes: Comparison.\n\nEach is a Model with a tree, a Result, a TriangleMesh, a PointCloud, "
             "or the name of a file with one of these. Further keywords are fields of CompareOptions. progress: "
             "callable(stage, done, total).\n\nRaises Error when a shape is empty or unbounded.");
}

}  // namespace cloud2csg::python
