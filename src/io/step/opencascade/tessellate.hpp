#pragma once

#include "cloud2csg/mesh.hpp"
#include "io/step/opencascade/bodies.hpp"

namespace cloud2csg::brep {

/// The bodies' surfaces as triangles, no farther from these than `deviation`: an edge has the same corners in both of
/// its faces, so that each body is closed. Bodies have no corners in common.
/// @throws Standard_Failure, std::runtime_error where a face has no triangles
[[nodiscard]] TriangleMesh tessellate(const Bodies& bodies, double deviation);

}  // namespace cloud2csg::brep
