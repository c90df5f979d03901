#pragma once

#include "cloud2csg/primitive.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::script {

/// What a primitive is in programs that know exact solids: a half-space is a block that reaches beyond `everything`,
/// polytopes and what has no exact surface (in cells of `resolution` along the longest side) have facets. A frustum
/// with equal ends is a cylinder; a torus has a hole, if only a pinhole: these programs take no others.
[[nodiscard]] brep::KernelSolid solid_of(const Primitive& primitive, const AlignedBox& everything, int resolution);

/// The surface of a solid in its own frame, with as much outside of it as inside.
[[nodiscard]] brep::Facets facets_of(Primitive primitive, const AlignedBox& everything, int resolution);

/// The connected pieces of a surface, the one around most first: those that turn inward are holes in one before.
[[nodiscard]] std::vector<brep::Facets> shells_of(const brep::Facets& facets);

/// Of a closed surface, negative when it turns inward.
[[nodiscard]] double volume_of(const brep::Facets& facets);

}  // namespace cloud2csg::script
