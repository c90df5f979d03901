#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "field_arrays.hpp"
#include "raw_options.hpp"
#include "result.hpp"

namespace cloud2csg::python {

ReconstructOptions raw_options(const ReconstructOptions& options, const Cloud& cloud,
                               std::optional<std::uint64_t> seed) {
  ReconstructOptions raw = seed ? with_seed(options, *seed) : options;
  if (cloud.is_exact()) raw.preparation.is_exact = true;
  return raw;
}

namespace {

Result detect(const py::object& cloud, const std::optional<ReconstructOptions>& options,
              std::optional<std::uint64_t> seed, int threads, const py::object& progress) {
  const auto given = to_cloud(cloud).cast<std::shared_ptr<Cloud>>();
  const ReconstructOptions raw = raw_options(options.value_or(ReconstructOptions{}), *given, seed);
  return result_of(run_work({.threads = threads, .progress = progress},
                            [&](const RunContext& run) { return find_primitives(given->points(), raw, run); }),
                   given);
}

using SurfaceClass = py::class_<DetectedSurface, std::shared_ptr<DetectedSurface>>;

void bind_surface(py::module_& module) {
  SurfaceClass(module, "DetectedSurface",
               "An unbounded surface on which points lie: a plane, sphere, cylinder, cone or torus.")
      .def_property_readonly(
          "type", [](const DetectedSurface& self) { return std::string(type_name(self.surface.type)); },
          "'plane', 'sphere', 'cylinder', 'cone', 'torus'.")
      .def_property_readonly(
          "position", [](const DetectedSurface& self) { return self.surface.position; },
          "Shape (3,): a point of the plane or of a cylinder's axis, the centre of a sphere or torus, the apex of a "
          "cone.")
      .def_property_readonly(
          "axis", [](const DetectedSurface& self) { return self.surface.axis; },
          "Shape (3,), unit length: the outward normal of a plane, or an axis. Meaningless for spheres.")
      .def_property_readonly(
          "radius", [](const DetectedSurface& self) { return self.surface.radius; },
          "Radius of a sphere or cylinder, or major radius of a torus, in the cloud's units. Below that of the tube, "
          "as of an apple, or negative, as of a lemon, if the tube crosses the axis.")
      .def_property_readonly(
          "minor_radius", [](const DetectedSurface& self) { return self.surface.minor_radius; },
          "Radius of a torus' tube.")
      .def_property_readonly(
          "half_angle", [](const DetectedSurface& self) { return self.surface.half_angle; },
          "Angle between axis and surface of a cone, in radians.")
      .def_property_readonly(
          "concave", [](const DetectedSurface& self) { return self.surface.concave; },
          "Whether the material is on the outside, as around a hole.")
      .def_readonly("rms", &DetectedSurface::rms, "Root mean square distance of its points, in the cloud's units.")
      .def_property_readonly(
          "points", [](const py::object& self) { return view(self.cast<const DetectedSurface&>().points, self); },
          "Indices into Result.cloud of the points on the surface, ascending: shape (k,), uint32, read-only, no copy.")
      .def(
          "distance",
          [](const DetectedSurface& self, const py::object& points) {
            return distances_at(points, {}, [&](PointsView at) { return signed_distance(self.surface, at); });
          },
          py::arg("points"), "Signed distance at points of shape (n, 3), negative inside the material: shape (n,).")
      .def("__repr__", [](const DetectedSurface& self) {
        return fmt::format("<cloud2csg.DetectedSurface: {}{}, {} points, rms {:.3g}>",
                           self.surface.concave ? "concave " : "", type_name(self.surface.type), self.points.size(),
                           self.rms);
      });
}

}  // namespace

void bind_detect(py::module_& module) {
  bind_surface(module);
  module.def("detect", &detect, py::arg("cloud"), py::arg("options") = py::none(), py::kw_only(),
             py::arg("seed") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
             "Detects the surfaces of a raw cloud, the solids that they bound, and a tree over the solids: "
             "Result.\n\ncloud: PointCloud, or positions of shape (n, 3). options: ReconstructOptions. seed: replaces "
             "all seeds in the options. threads: 0 = all cores; the result does not depend on them. progress: "
             "callable(stage, done, total).\n\nRaises Error when no surface is found.");
}

}  // namespace cloud2csg::python
