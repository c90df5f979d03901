#pragma once

#include "cloud2csg/mesh.hpp"

namespace cloud2csg::brep {

/// Moves the vertices of a mesh of the tree's surface a little, such that its triangles lie as much outside of that
/// surface as inside: a mesh with its vertices on a round surface is too small. Flat faces stay as they are.
/// O(triangles x size)
void balance_facets(TriangleMesh& mesh, const Model& model);

}  // namespace cloud2csg::brep
