#include "io/step/opencascade/make_body.hpp"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax2.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "io/step/opencascade/facet_shells.hpp"
#include "io/step/opencascade/split_sphere.hpp"

namespace cloud2csg::brep {
namespace {

gp_Ax2 axis_from(double height) {
  return {gp_Pnt(0, 0, height), gp_Dir(0, 0, 1)};
}

TopoDS_Shape centred(const Box& box) {
  const Eigen::Vector3d half = 0.5 * box.size;
  return BRepPrimAPI_MakeBox(gp_Pnt(-half.x(), -half.y(), -half.z()), gp_Pnt(half.x(), half.y(), half.z())).Solid();
}

TopoDS_Shape centred(const Sphere& sphere) {
  return BRepPrimAPI_MakeSphere(sphere.radius).Solid();
}

TopoDS_Shape centred(const Cylinder& cylinder) {
  return BRepPrimAPI_MakeCylinder(axis_from(-0.5 * cylinder.height), cylinder.radius, cylinder.height).Solid();
}

TopoDS_Shape centred(const Cone& cone) {
  // The kernel refuses cones whose sides are parallel.
  if (std::abs(cone.radius_bottom - cone.radius_top) <= Precision::Confusion()) {
    return centred(Cylinder{.radius = 0.5 * (cone.radius_bottom + cone.radius_top), .height = cone.height});
  }
  return BRepPrimAPI_MakeCone(axis_from(-0.5 * cone.height), cone.radius_bottom, cone.radius_top, cone.height).Solid();
}

TopoDS_Shape centred(const Torus& torus) {
  // The kernel refuses tori without a hole: a pinhole stays.
  constexpr double k_pinhole = 1e-5;
  const double minor = std::min(torus.minor_radius, (1 - k_pinhole) * torus.major_radius);
  return BRepPrimAPI_MakeTorus(torus.major_radius, minor).Solid();
}

TopoDS_Shape placed(const TopoDS_Shape& shape, const Pose& pose) {
  gp_Trsf motion;
  const Eigen::Quaterniond& q = pose.orientation;
  motion.SetTransformation(gp_Quaternion(q.x(), q.y(), q.z(), q.w()),
                           gp_Vec(pose.position.x(), pose.position.y(), pose.position.z()));
  // Into the geometry itself: some operations of the kernel lose precision with nested locations.
  return BRepBuilderAPI_Transform(shape, motion, true).Shape();
}

}  // namespace

Bodies make_bodies(const KernelSolid& solid, SphereForm spheres) {
  const auto* sphere = std::get_if<Sphere>(&solid.shape);
  if (sphere != nullptr && spheres == SphereForm::split) {
    return {body_of(placed(split_sphere(sphere->radius), solid.pose))};
  }
  if (const auto* facets = std::get_if<Facets>(&solid.shape)) {
    Facets moved = *facets;
    for (Eigen::Vector3d& corner : moved.corners) corner = solid.pose.to_world(corner);
    return make_bodies(moved);
  }
  return std::visit(
      [&](const auto& shape) -> Bodies {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, Facets>) {
          return {};
        } else {
          return {body_of(placed(centred(shape), solid.pose))};
        }
      },
      solid.shape);
}

Bodies make_bodies(const Facets& facets) {
  Bodies bodies;
  for (const TopoDS_Shape& solid : solids_of_facets(facets)) bodies.push_back(body_of(solid));
  return bodies;
}

Body make_block(const AlignedBox& box) {
  return body_of(BRepPrimAPI_MakeBox(gp_Pnt(box.min().x(), box.min().y(), box.min().z()),
                                     gp_Pnt(box.max().x(), box.max().y(), box.max().z()))
                     .Solid());
}

}  // namespace cloud2csg::brep
