#include <pybind11/stl.h>

#include <optional>

#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/sample.hpp"
#include "model.hpp"
#include "option_class.hpp"

namespace cloud2csg::python {
namespace {

[[noreturn]] void refuse(const char* function) {
  throw py::type_error(std::string(function) + ": expected a Model or a TriangleMesh");
}

Cloud sample(const py::object& shape, const std::optional<SampleOptions>& options, int threads,
             const py::object& progress, const py::kwargs& fields) {
  const SampleOptions sampling = with_fields(options, fields);
  const RunArguments arguments{.threads = threads, .progress = progress};
  if (py::isinstance<TriangleMesh>(shape)) {
    const auto& mesh = shape.cast<const TriangleMesh&>();
    return Cloud(run_work(arguments, [&](const RunContext& run) { return sample_mesh_surface(mesh, sampling, run); }));
  }
  if (!py::isinstance<Model>(shape)) refuse("sample");
  const auto& model = shape.cast<const Model&>();
  return Cloud(run_work(arguments, [&](const RunContext& run) { return sample_surface(model, sampling, run); }));
}

Cloud scan(const py::object& shape, const std::optional<ScanOptions>& options, int threads, const py::object& progress,
           const py::kwargs& fields) {
  const ScanOptions scanning = with_fields(options, fields);
  const RunArguments arguments{.threads = threads, .progress = progress};
  if (py::isinstance<TriangleMesh>(shape)) {
    const auto& mesh = shape.cast<const TriangleMesh&>();
    return Cloud(run_work(arguments, [&](const RunContext& run) { return scan_mesh(mesh, scanning, run); }));
  }
  if (!py::isinstance<Model>(shape)) refuse("scan");
  const auto& model = shape.cast<const Model&>();
  return Cloud(run_work(arguments, [&](const RunContext& run) { return scan_model(model, scanning, run); }));
}

}  // namespace

void bind_synth(py::module_& module) {
  module.def("sample", &sample, py::arg("shape"), py::arg("options") = py::none(), py::kw_only(),
             py::arg("threads") = 0, py::arg("progress") = py::none(),
             "Draws points from the surface of a Model or TriangleMesh, uniformly by area, with outward normals: "
             "PointCloud.\n\nNormals are those of the positions before the noise. Further keywords are fields of "
             "SampleOptions: sample(model, count=50_000, noise=0.01). progress: callable(stage, done, "
             "total).\n\nRaises Error when the solid is empty or unbounded.");
  module.def(
      "scan", &scan, py::arg("shape"), py::arg("options") = py::none(), py::kw_only(), py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "Simulates a range scanner around a Model or TriangleMesh: PointCloud with sensor positions.\n\nFurther keywords "
      "are fields of ScanOptions. progress: callable(stage, done, total). Raises Error when the scanner sees nothing.");
}

}  // namespace cloud2csg::python
