#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "cloud2csg/primitive.hpp"
#include "field_arrays.hpp"

namespace cloud2csg::python {
namespace {

using Eigen::Vector3d;
using PlaneRows = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

std::string text_of(const Vector3d& v) {
  return fmt::format("({}, {}, {})", v.x(), v.y(), v.z());
}

void bind_round_shapes(py::module_& module) {
  py::class_<Sphere>(module, "Sphere", "Centred at the origin of its own frame. radius: > 0, in the cloud's units.")
      .def(py::init([](double radius) { return Sphere{radius}; }), py::arg("radius"))
      .def_readonly("radius", &Sphere::radius, "Length.")
      .def("__repr__", [](const Sphere& self) { return fmt::format("Sphere(radius={})", self.radius); });
  py::class_<Cylinder>(module, "Cylinder", "A cylinder along local z, centred: |z| <= height / 2.")
      .def(py::init([](double radius, double height) {
             return Cylinder{radius, height};
           }),
           py::arg("radius"), py::arg("height"))
      .def_readonly("radius", &Cylinder::radius, "Length.")
      .def_readonly("height", &Cylinder::height, "Length.")
      .def("__repr__", [](const Cylinder& self) {
        return fmt::format("Cylinder(radius={}, height={})", self.radius, self.height);
      });
  py::class_<Cone>(module, "Cone",
                   "A frustum along local z, centred; radius_bottom at z = -height / 2. One of the radii may be 0.")
      .def(py::init([](double bottom, double top, double height) {
             return Cone{bottom, top, height};
           }),
           py::arg("radius_bottom"), py::arg("radius_top"), py::arg("height"))
      .def_readonly("radius_bottom", &Cone::radius_bottom, "Length.")
      .def_readonly("radius_top", &Cone::radius_top, "Length.")
      .def_readonly("height", &Cone::height, "Length.")
      .def("__repr__", [](const Cone& self) {
        return fmt::format("Cone(radius_bottom={}, radius_top={}, height={})", self.radius_bottom, self.radius_top,
                           self.height);
      });
  py::class_<Torus>(module, "Torus", "A torus around local z; minor_radius <= major_radius.")
      .def(py::init([](double major, double minor) {
             return Torus{major, minor};
           }),
           py::arg("major_radius"), py::arg("minor_radius"))
      .def_readonly("major_radius", &Torus::major_radius, "Distance from the centre to the middle of the tube.")
      .def_readonly("minor_radius", &Torus::minor_radius, "Radius of the tube.")
      .def("__repr__", [](const Torus& self) {
        return fmt::format("Torus(major_radius={}, minor_radius={})", self.major_radius, self.minor_radius);
      });
}

Polytope make_polytope(const PlaneRows& rows) {
  Polytope polytope;
  polytope.planes.reserve(static_cast<std::size_t>(rows.rows()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const double length = rows.row(i).head<3>().norm();
    if (!(length > 0)) throw py::value_error(fmt::format("planes: expected a normal, found length 0 in row {}", i));
    polytope.planes.push_back({.normal = rows.row(i).head<3>() / length, .offset = rows(i, 3) / length});
  }
  return polytope;
}

PlaneRows planes_of(const Polytope& polytope) {
  PlaneRows rows(static_cast<Eigen::Index>(polytope.planes.size()), 4);
  for (std::size_t i = 0; i < polytope.planes.size(); ++i) {
    const Plane& plane = polytope.planes[i];
    rows.row(static_cast<Eigen::Index>(i)) << plane.normal.transpose(), plane.offset;
  }
  return rows;
}

using PathLists = std::vector<std::vector<std::vector<double>>>;

Profile make_profile(const PathLists& lists) {
  Profile profile;
  for (const auto& corners : lists) {
    ClosedPath& path = profile.paths.emplace_back();
    for (const std::vector<double>& corner : corners) {
      if (corner.size() != 2 && corner.size() != 3) {
        throw py::value_error(
            fmt::format("profile: expected corners (x, y) or (x, y, bulge), found {} numbers in "
                        "corner {} of path {}",
                        corner.size(), path.size(), profile.paths.size() - 1));
      }
      path.push_back({.point = {corner[0], corner[1]}, .bulge = corner.size() == 3 ? corner[2] : 0.0});
    }
  }
  return profile;
}

PathLists lists_of(const Profile& profile) {
  PathLists lists;
  for (const ClosedPath& path : profile.paths) {
    auto& corners = lists.emplace_back();
    for (const PathCorner& corner : path) corners.push_back({corner.point.x(), corner.point.y(), corner.bulge});
  }
  return lists;
}

std::string text_of(const Profile& profile) {
  return py::repr(py::cast(lists_of(profile))).cast<std::string>();
}

void bind_flat_shapes(py::module_& module) {
  py::class_<Box>(module, "Box", "Centred at the origin of its own frame. size: edge lengths, shape (3,).")
      .def(py::init([](const Vector3d& size) { return Box{size}; }), py::arg("size"))
      .def_property_readonly(
          "size", [](const Box& self) { return self.size; }, "Edge lengths, shape (3,).")
      .def("__repr__", [](const Box& self) { return fmt::format("Box(size={})", text_of(self.size)); });
  py::class_<HalfSpace>(module, "HalfSpace", "The half-space z <= 0 of its own frame.")
      .def(py::init<>())
      .def("__repr__", [](const HalfSpace&) { return "HalfSpace()"; });
  py::class_<Polytope>(module, "Polytope",
                       "A bounded intersection of half-spaces with a volume. planes: rows (nx, ny, nz, offset), shape "
                       "(k, 4), for normal . x <= offset.")
      .def(py::init(&make_polytope), py::arg("planes"))
      .def_property_readonly("planes", &planes_of,
                             "Rows (nx, ny, nz, offset), shape (k, 4), with normals of unit length.")
      .def("__repr__", [](const Polytope& self) { return fmt::format("<Polytope of {} planes>", self.planes.size()); });
}

void bind_profiles(py::module_& module) {
  py::class_<Extrusion>(
      module, "Extrusion",
      "A profile in local x, y times |z| <= height / 2. profile: closed paths, each a list of corners "
      "(x, y) or, where an arc starts, (x, y, bulge): bulge = tan(angle / 4), positive if it turns "
      "left. Inside is what an odd number of paths surrounds.")
      .def(py::init([](const PathLists& profile, double height) {
             return Extrusion{make_profile(profile), height};
           }),
           py::arg("profile"), py::arg("height"))
      .def_property_readonly(
          "profile", [](const Extrusion& self) { return lists_of(self.profile); }, "Closed paths of (x, y, bulge).")
      .def_readonly("height", &Extrusion::height, "Length along local z.")
      .def("__repr__", [](const Extrusion& self) {
        return fmt::format("Extrusion({}, height={})", text_of(self.profile), self.height);
      });
  py::class_<Revolution>(
      module, "Revolution",
      "A profile in the half-plane (r, z), r >= 0, turned about local z, from local x towards y where "
      "the angle is below 360. profile: as of Extrusion.")
      .def(py::init([](const PathLists& profile, double angle_deg) {
             return Revolution{make_profile(profile), angle_deg};
           }),
           py::arg("profile"), py::arg("angle_deg") = 360)
      .def_property_readonly(
          "profile", [](const Revolution& self) { return lists_of(self.profile); }, "Closed paths of (r, z, bulge).")
      .def_readonly("angle_deg", &Revolution::angle_deg, "The turn in degrees, above 0 and at most 360.")
      .def("__repr__", [](const Revolution& self) {
        return fmt::format("Revolution({}, angle_deg={})", text_of(self.profile), self.angle_deg);
      });
}

void bind_expression(py::module_& module) {
  py::class_<Expression>(module, "Expression",
                         "A solid given by a formula in x, y, z (muParser syntax), negative inside. lower and upper, "
                         "shape (3,), are corners of a box around the solid, in its own frame.")
      .def(py::init([](std::string distance, const Vector3d& lower, const Vector3d& upper) {
             return Expression{std::move(distance), AlignedBox(lower, upper)};
           }),
           py::arg("distance"), py::arg("lower"), py::arg("upper"))
      .def_readonly("distance", &Expression::distance, "The formula.")
      .def_property_readonly(
          "lower", [](const Expression& self) { return self.bounds.min(); }, "Least corner, shape (3,).")
      .def_property_readonly(
          "upper", [](const Expression& self) { return self.bounds.max(); }, "Greatest corner, shape (3,).")
      .def("__repr__", [](const Expression& self) {
        return fmt::format("Expression({}, lower={}, upper={})", py::repr(py::cast(self.distance)).cast<std::string>(),
                           text_of(self.bounds.min()), text_of(self.bounds.max()));
      });
}

Primitive make_primitive(std::string id, Shape shape, const Vector3d& position, const Eigen::Vector4d& quaternion,
                         std::optional<double> displacement_frequency) {
  if (!position.allFinite()) throw py::value_error("position: expected finite numbers");
  if (!quaternion.allFinite() || quaternion.isZero(0)) {
    throw py::value_error("quaternion: expected finite numbers (w, x, y, z), not all 0");
  }
  Eigen::Quaterniond orientation(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
  constexpr double k_rounding = 1e-15;
  if (std::abs(orientation.squaredNorm() - 1) > k_rounding) orientation.normalize();
  Primitive primitive{.id = std::move(id), .shape = std::move(shape), .pose = {position, orientation}};
  if (displacement_frequency) primitive.displacement = Displacement{*displacement_frequency};
  validate(primitive);
  return primitive;
}

Eigen::Vector4d quaternion_of(const Primitive& primitive) {
  const Eigen::Quaterniond& q = primitive.pose.orientation;
  return {q.w(), q.x(), q.y(), q.z()};
}

std::string repr_of_primitive(const Primitive& self) {
  const Eigen::Vector4d q = quaternion_of(self);
  return fmt::format(
      "Primitive({}, {}, position={}, quaternion=({}, {}, {}, {}){})", py::repr(py::cast(self.id)).cast<std::string>(),
      py::repr(py::cast(self.shape)).cast<std::string>(), text_of(self.pose.position), q[0], q[1], q[2], q[3],
      self.displacement ? fmt::format(", displacement_frequency={}", self.displacement->frequency) : "");
}

void bind_primitive(py::module_& module) {
  py::class_<Primitive>(
      module, "Primitive",
      "A named solid. Immutable.\n\nshape: Box, Sphere, Cylinder, Cone, Torus, HalfSpace, Polytope, Extrusion, "
      "Revolution or Expression, in its own frame. position, shape (3,), and quaternion, (w, x, y, z), place it in the "
      "world: x_world = rotation "
      "x_local + position. displacement_frequency k: adds sin(kx) sin(ky) sin(kz) to the distance, in the shape's own "
      "frame.\n\nRaises Error for sizes that make no solid.")
      .def(py::init(&make_primitive), py::arg("id"), py::arg("shape"),
           py::arg_v("position", Vector3d(0, 0, 0), "(0, 0, 0)"),
           py::arg_v("quaternion", Eigen::Vector4d(1, 0, 0, 0), "(1, 0, 0, 0)"),
           py::arg("displacement_frequency") = py::none())
      .def_readonly("id", &Primitive::id, "The name, unique in a model.")
      .def_readonly("shape", &Primitive::shape, "Box, Sphere, ...: a copy.")
      .def_property_readonly(
          "type", [](const Primitive& self) { return std::string(type_name(self.shape)); },
          "Type name as in model files: 'box', 'sphere', 'cylinder', 'cone', 'torus', 'half_space', 'polytope', "
          "'extrusion', 'revolution', 'expression'.")
      .def_property_readonly(
          "position", [](const Primitive& self) { return self.pose.position; },
          "Position of the frame's origin, shape (3,).")
      .def_property_readonly("quaternion", &quaternion_of, "Orientation (w, x, y, z), unit length, shape (4,).")
      .def_property_readonly(
          "displacement_frequency",
          [](const Primitive& self) {
            return self.displacement ? std::optional(self.displacement->frequency) : std::nullopt;
          },
          "Frequency of the sine displacement, or None.")
      .def_property_readonly(
          "bounds", [](const Primitive& self) { return to_array(bounds(self)); },
          "[[least x, y, z], [greatest x, y, z]] in the world, shape (2, 3); infinite for half-spaces.")
      .def(
          "distance",
          [](const Primitive& self, const py::object& points) {
            return distances_at(points, {}, [&](PointsView at) { return signed_distance(self, at); });
          },
          py::arg("points"), "Signed distance at points of shape (n, 3), negative inside: shape (n,).")
      .def(
          "gradient",
          [](const Primitive& self, const py::object& points) {
            return gradients_at(points, {}, [&](PointsView at) { return gradient(self, at); });
          },
          py::arg("points"), "Gradient of distance() at points of shape (n, 3), not normalised: shape (n, 3).")
      .def("__repr__", &repr_of_primitive);
}

}  // namespace

void bind_primitives(py::module_& module) {
  bind_flat_shapes(module);
  bind_profiles(module);
  bind_expression(module);
  bind_round_shapes(module);
  bind_primitive(module);
}

}  // namespace cloud2csg::python
