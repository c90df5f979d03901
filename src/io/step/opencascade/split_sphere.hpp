#pragma once

#include <TopoDS_Shape.hxx>

namespace cloud2csg::brep {

/// A sphere at the origin whose surface is four curved triangles. Each has its poles and its seam elsewhere, so that
/// whatever is cut out of it has plain edges only: readers of STEP get spheres wrong that are cut around both poles.
/// @throws Standard_Failure
[[nodiscard]] TopoDS_Shape split_sphere(double radius);

}  // namespace cloud2csg::brep
