#pragma once

#include <string>

#include "cloud2csg/primitive.hpp"
#include "export/openscad_text.hpp"

namespace cloud2csg::openscad {

struct SolidContext {
  AlignedBox everything;  ///< finite; half-spaces reach to its ends
  int mesh_resolution;    ///< of solids that OpenSCAD has no name for
  NumberFormat number;
};

/// Whether the solid becomes a long list of triangles: displaced solids and expressions.
[[nodiscard]] bool needs_mesh(const Primitive& primitive);

/// The OpenSCAD statement for a primitive, in place: `translate([0, 0, 1]) cylinder(h = 2, r = 1, center = true);`
[[nodiscard]] std::string solid(const Primitive& primitive, const SolidContext& context);

}  // namespace cloud2csg::openscad
