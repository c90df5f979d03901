#pragma once

#include <Bnd_Box.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// One solid with its slightly enlarged bounds.
struct Body {
  TopoDS_Shape shape;
  Bnd_Box box;
};
/// Solids with disjoint interiors.
using Bodies = std::vector<Body>;

[[nodiscard]] Body body_of(const TopoDS_Shape& solid);
[[nodiscard]] Bodies bodies_of(const TopoDS_Shape& shape);
/// The solid itself, or a compound of several.
[[nodiscard]] TopoDS_Shape shape_of(const Bodies& bodies);

/// @throws Standard_Failure
[[nodiscard]] double volume_of(const TopoDS_Shape& shape);
[[nodiscard]] double volume_of(const Bodies& bodies);
[[nodiscard]] bool is_valid(const TopoDS_Shape& shape);

struct Healed {
  TopoDS_Shape shape;
  std::size_t faces;  ///< invalid faces before healing
};
/// Repairs faults of a shape where possible. @throws Standard_Failure
[[nodiscard]] Healed healed(const TopoDS_Shape& shape);

/// Joins faces on one surface, except on spheres split on purpose. The shape itself if that fails or spoils the solid.
[[nodiscard]] TopoDS_Shape with_joined_faces(const TopoDS_Shape& shape);

/// Whether the volume stays the same, within the relative `tolerance`, when measured from another point; gaps in the
/// surface change it. The kernel's own check ignores gaps within its tolerance.
[[nodiscard]] bool is_closed(const Body& body, double tolerance);

}  // namespace cloud2csg::brep
