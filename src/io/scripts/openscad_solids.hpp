#pragma once

#include <optional>
#include <string>

#include "cloud2csg/primitive.hpp"
#include "io/scripts/openscad_parameters.hpp"
#include "io/scripts/openscad_text.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::openscad {

struct SolidContext {
  AlignedBox everything;  ///< finite; half-spaces reach to its ends
  int mesh_resolution;    ///< of solids that OpenSCAD has no name for
  script::NumberFormat number;
  int facets;  ///< of a full circle
};

/// Where the profile of a torus touches the axis the solid is no 2-manifold, which OpenSCAD refuses: the radius of the
/// pinhole that is left there, in units of the minor radius. Absent for a torus with a hole.
[[nodiscard]] std::optional<double> pinhole_of(const Torus& torus, int facets);

/// Whether the solid becomes a long list of triangles: displaced solids and expressions.
[[nodiscard]] bool needs_mesh(const Primitive& primitive);

/// The OpenSCAD statement for a primitive, in place, by the values that it adds to `parameters`:
/// `translate(bore_position) cylinder(h = bore_height, r = bore_radius, center = true);`
[[nodiscard]] std::string solid(const Primitive& primitive, const SolidContext& context, Parameters& parameters);

/// `points = ...,<separator>faces = ...`, as polyhedron() takes them.
[[nodiscard]] std::string facet_lists(const brep::Facets& facets, const script::NumberFormat& number,
                                      const std::string& separator);

}  // namespace cloud2csg::openscad
