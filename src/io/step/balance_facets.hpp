#pragma once

#include "cloud2csg/mesh.hpp"

namespace cloud2csg::brep {

/// Moves the vertices of a mesh so that its triangles lie as much outside the tree's surface as inside. With all
/// vertices on a round surface, a mesh is too small. Flat faces do not change. O(triangles x size)
void balance_facets(TriangleMesh& mesh, const Model& model);

}  // namespace cloud2csg::brep
