#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cloud.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/mesh.hpp"
#include "io/formats/formats.hpp"
#include "option_class.hpp"
#include "run_work.hpp"

namespace cloud2csg::python {

py::object Cloud::rows(const Points& points, py::object& kept) const {
  if (points.empty() && !points_.positions.empty()) return py::none();
  if (!kept) kept = read_only(to_rows(points));
  return kept;
}

py::object to_cloud(const py::object& cloud) {
  if (py::isinstance<Cloud>(cloud)) return cloud;
  return py::type::of<Cloud>()(cloud);
}

namespace {

using Indices = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

/// Scales directions to unit length; unit vectors keep their bits.
void normalise(Points& normals) {
  constexpr double k_rounding = 8 * std::numeric_limits<double>::epsilon();  // as read_point_cloud()
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d normal = normals[i];
    if (normal.isZero(0)) {
      throw py::value_error(fmt::format("normals: expected directions, found length 0 in row {}", i));
    }
    if (std::abs(normal.squaredNorm() - 1) > k_rounding) normals.set(i, normal.stableNormalized());
  }
}

Points as_many(const py::object& values, const char* name, std::size_t count) {
  if (values.is_none()) return {};
  const PointArray array(values, name);
  if (array.size() == count) return array.columns();
  throw py::value_error(fmt::format("{}: expected as many rows as positions, {}, found {}", name, count, array.size()));
}

Cloud make_cloud(const py::object& positions, const py::object& normals, const py::object& sensor_positions,
                 bool is_exact) {
  PointCloud points{.positions = PointArray(positions, "positions").columns()};
  points.normals = as_many(normals, "normals", points.size());
  normalise(points.normals);
  points.sensor_positions = as_many(sensor_positions, "sensor_positions", points.size());
  return Cloud(std::move(points), is_exact);
}

Cloud select(const Cloud& cloud, const Indices& indices) {
  const std::span<const std::uint32_t> wanted(indices.data(), static_cast<std::size_t>(indices.size()));
  for (const std::uint32_t index : wanted) {
    if (index >= cloud.points().size()) {
      throw py::index_error(fmt::format("point {} of {}", index, cloud.points().size()));
    }
  }
  return Cloud(select_points(cloud.points(), wanted), cloud.is_exact());
}

py::object columns_or_none(const Points& points, const py::object& self) {
  if (points.empty()) return py::none();
  return column_views(points, self);
}

const PointCloud& points_of(const py::object& self) {
  return self.cast<const Cloud&>().points();
}

void bind_arrays(py::class_<Cloud, std::shared_ptr<Cloud>>& cloud) {
  cloud
      .def_property_readonly("positions", &Cloud::position_rows,
                             "Shape (n, 3), float64, read-only, in the cloud's units. Copied from the library's "
                             "columns on first use; later uses return the same array.")
      .def_property_readonly("normals", &Cloud::normal_rows,
                             "Outward unit normals, shape and type as `positions`. None if the cloud has none.")
      .def_property_readonly(
          "sensor_positions", &Cloud::sensor_rows,
          "Position of the sensor that saw each point, shape and type as `positions`. None if unknown.")
      .def_property_readonly(
          "position_columns", [](const py::object& self) { return column_views(points_of(self).positions, self); },
          "Columns (x, y, z), each of shape (n,), float64, read-only, in the library's own memory (no copies).")
      .def_property_readonly(
          "normal_columns", [](const py::object& self) { return columns_or_none(points_of(self).normals, self); },
          "As `position_columns`, or None if the cloud has no normals.")
      .def_property_readonly(
          "sensor_columns",
          [](const py::object& self) { return columns_or_none(points_of(self).sensor_positions, self); },
          "As `position_columns`, or None if the cloud has no sensor positions.");
}

void bind_cloud(py::module_& module) {
  py::class_<Cloud, std::shared_ptr<Cloud>> cloud(
      module, "PointCloud",
      "Points with outward unit normals and the positions of their sensors, if known. Immutable.\n\npositions, "
      "normals, sensor_positions: shape (n, 3); normals and sensor_positions may be None. They are copied once into "
      "the library's columns; float32, integers and lists are converted. Normals are scaled to unit length.\nis_exact: "
      "the points lie on the surface and have its normals, such as points drawn from an exact mesh.\n\nRaises "
      "ValueError for other shapes, NaN, infinity, and normals of length 0.");
  cloud.def(py::init(&make_cloud), py::arg("positions"), py::arg("normals") = py::none(),
            py::arg("sensor_positions") = py::none(), py::arg("is_exact") = false);
  bind_arrays(cloud);
  cloud.def("__len__", [](const Cloud& self) { return self.points().size(); })
      .def_property_readonly("is_exact", &Cloud::is_exact,
                             "Whether the points were drawn from an exact mesh or are equally exact.")
      .def_property_readonly("warnings", &Cloud::warnings, "Sentences about doubts when the cloud was read.")
      .def("select", &select, py::arg("indices"),
           "The points with these indices, shape (k,), in this order, with their normals and sensor positions.")
      .def(
          "write",
          [](const Cloud& self, const std::filesystem::path& file, const std::optional<CloudWriteOptions>& options) {
            const py::gil_scoped_release unlocked;
            check_overwriting(file);
            write_point_cloud(file, self.points(), options.value_or(CloudWriteOptions{}));
          },
          py::arg("file"), py::arg("options") = py::none(),
          "Writes a file by its ending: .ply .pcd .xyz .xyzn .txt .pts. Never leaves a partial file; does not "
          "overwrite a file of another kind.")
      .def("__repr__",
           [](const Cloud& self) {
             return fmt::format("<cloud2csg.PointCloud: {} points{}{}>", self.points().size(),
                                self.points().has_normals() ? ", with normals" : "",
                                self.points().has_sensor_positions() ? ", with sensor positions" : "");
           })
      .def(py::pickle(
          [](Cloud& self) {
            return py::make_tuple(self.position_rows(), self.normal_rows(), self.sensor_rows(), self.is_exact());
          },
          [](const py::tuple& state) { return make_cloud(state[0], state[1], state[2], state[3].cast<bool>()); }));
}

TriangleMesh make_mesh(const py::object& vertices, const Indices& triangles) {
  TriangleMesh mesh{.vertices = PointArray(vertices, "vertices").columns(), .triangles = {}};
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) {
    throw py::value_error("triangles: expected an array of shape (m, 3)");
  }
  mesh.triangles.resize(static_cast<std::size_t>(triangles.shape(0)));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = triangles.data()[3 * i + corner];
      if (vertex >= mesh.vertices.size()) {
        throw py::value_error(fmt::format("triangles: expected indices of vertices, found {} in row {}", vertex, i));
      }
      mesh.triangles[i][corner] = vertex;
    }
  }
  return mesh;
}

py::array triangles_of(const py::object& self) {
  const auto& mesh = self.cast<const TriangleMesh&>();
  const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(mesh.triangles.size()), 3};
  const std::uint32_t* const first = mesh.triangles.empty() ? nullptr : mesh.triangles.front().data();
  return read_only(py::array_t<std::uint32_t>(shape, first, self));
}

void bind_mesh(py::module_& module) {
  py::class_<TriangleMesh, std::shared_ptr<TriangleMesh>>(
      module, "TriangleMesh",
      "Triangles over shared vertices, counter-clockwise seen from outside. Immutable.\n\nvertices: shape (n, 3). "
      "triangles: indices of vertices, shape (m, 3). Both are copied.")
      .def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"))
      .def_property_readonly(
          "vertices", [](const TriangleMesh& self) { return to_rows(self.vertices); },
          "Shape (n, 3), float64: a new copy at each use.")
      .def_property_readonly("triangles", &triangles_of,
                             "Indices of vertices, shape (m, 3), uint32, read-only, in the library's memory (no copy).")
      .def_property_readonly("is_watertight", &is_watertight,
                             "Whether every edge has exactly two triangles, in opposite directions.")
      .def_property_readonly(
          "volume", &volume_of,
          "Volume enclosed by a closed mesh, in cubed units; positive when the mesh is oriented outward.")
      .def(
          "write",
          [](const TriangleMesh& self, const std::filesystem::path& file) {
            const py::gil_scoped_release unlocked;
            check_overwriting(file);
            write_mesh(file, self);
          },
          py::arg("file"),
          "Writes a file by its ending: .stl .off .obj .3mf. Never leaves a partial file; does not overwrite a file of "
          "another kind.")
      .def("__repr__", [](const TriangleMesh& self) {
        return fmt::format("<cloud2csg.TriangleMesh: {} vertices, {} triangles>", self.vertices.size(),
                           self.triangles.size());
      });
}

Cloud read_cloud(const std::filesystem::path& file, const std::optional<InputOptions>& options, int threads,
                 const py::object& progress, const py::kwargs& fields) {
  const InputOptions reading = with_fields(options, fields);
  Input input = run_work({.threads = threads, .progress = progress},
                         [&](const RunContext& run) { return read_cloud_or_mesh(file, reading, run); });
  return Cloud(std::move(input.cloud), input.is_exact, std::move(input.warnings));
}

}  // namespace

void bind_clouds(py::module_& module) {
  bind_cloud(module);
  bind_mesh(module);
  module.def("read_cloud", &read_cloud, py::arg("file"), py::arg("options") = py::none(), py::kw_only(),
             py::arg("threads") = 0, py::arg("progress") = py::none(),
             "Reads a point cloud (.ply .pcd .xyz .xyzn .txt .pts), or draws points with normals from a mesh (.stl "
             ".off .obj .3mf .glb, .ply with faces). The vertices of a mesh that was made from a scan are taken as a "
             "cloud.\n\nLeaves out invalid points and repairs meshes, with warnings in "
             "PointCloud.warnings. Further keywords are fields of InputOptions. Raises Error when the file cannot be "
             "read or has no valid points.");
  module.def(
      "read_mesh",
      [](const std::filesystem::path& file) {
        const py::gil_scoped_release unlocked;
        return read_mesh(file);
      },
      py::arg("file"), "Reads a mesh: .stl .off .obj .ply .3mf .glb. Raises Error when that fails.");
}

}  // namespace cloud2csg::python
