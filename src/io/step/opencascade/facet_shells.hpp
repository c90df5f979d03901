#pragma once

#include <TopoDS_Shape.hxx>
#include <vector>

#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// Solids of flat faces. Pieces of the surface that do not hang together by edges become solids each; those that are
/// turned inside out are hollows of the smallest solid around them. Faces too thin to have a plane are left out.
/// O(faces + hollows x solids)
/// @throws Standard_Failure
[[nodiscard]] std::vector<TopoDS_Shape> solids_of_facets(const Facets& facets);

}  // namespace cloud2csg::brep
