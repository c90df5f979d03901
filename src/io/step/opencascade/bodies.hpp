#pragma once

#include <Bnd_Box.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

#include "io/step/kernel.hpp"

/// Solids of OpenCASCADE, and what is known of them.
namespace cloud2csg::brep {

/// One solid with its bounds, which have a little room.
struct Body {
  TopoDS_Shape shape;
  Bnd_Box box;
};
/// Solids without common inside.
using Bodies = std::vector<Body>;

[[nodiscard]] Body body_of(const TopoDS_Shape& solid);
/// The solids of a shape.
[[nodiscard]] Bodies bodies_of(const TopoDS_Shape& shape);
/// The solid itself, or a compound of several.
[[nodiscard]] TopoDS_Shape shape_of(const Bodies& bodies);

/// @throws Standard_Failure
[[nodiscard]] double volume_of(const TopoDS_Shape& shape);
[[nodiscard]] double volume_of(const Bodies& bodies);
[[nodiscard]] bool is_valid(const TopoDS_Shape& shape);

struct Healed {
  TopoDS_Shape shape;
  std::size_t faces;  ///< that were invalid
};
/// A shape with faults mended where that is possible.
/// @throws Standard_Failure
[[nodiscard]] Healed healed(const TopoDS_Shape& shape);

/// Faces that lie on one surface joined, but for those of spheres that were split on purpose; the shape itself where
/// the kernel cannot do it, or spoils the solid by it.
[[nodiscard]] TopoDS_Shape with_joined_faces(const TopoDS_Shape& shape);

/// Whether the volume is the same when it is measured from elsewhere, but for `tolerance` of it: that of a surface with
/// gaps is not. The kernel's check of a solid finds no gaps that are within what it takes for its tolerance.
[[nodiscard]] bool is_closed(const Body& body, double tolerance);

}  // namespace cloud2csg::brep
