#pragma once

#include "io/step/opencascade/bodies.hpp"

namespace cloud2csg::brep {

/// One face, or four that are easier to read (make_body.cpp).
enum class SphereForm { whole, split };

/// The solids of a primitive or of facets: each closed piece is one, or a hollow in one. @throws Standard_Failure
[[nodiscard]] Bodies make_bodies(const KernelSolid& solid, SphereForm spheres);
[[nodiscard]] Bodies make_bodies(const Facets& facets);

[[nodiscard]] Body make_block(const AlignedBox& box);

}  // namespace cloud2csg::brep
