#pragma once

#include "cloud2csg/primitive.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::script {

/// A primitive for programs with exact solids. A half-space becomes a block that reaches beyond `everything`. Polytopes
/// and solids without an exact surface become facets (`resolution` cells along the longest side). A frustum with equal
/// ends becomes a cylinder. A torus gets at least a pinhole, which these programs require.
[[nodiscard]] brep::KernelSolid solid_of(const Primitive& primitive, const AlignedBox& everything, int resolution);

/// The surface in the solid's own frame, with as much volume outside the exact surface as inside.
[[nodiscard]] brep::Facets facets_of(Primitive primitive, const AlignedBox& everything, int resolution);

/// The connected pieces of a surface, by decreasing volume; pieces that face inward are holes in an earlier piece.
[[nodiscard]] std::vector<brep::Facets> shells_of(const brep::Facets& facets);

/// The volume of a closed surface; negative if it faces inward.
[[nodiscard]] double volume_of(const brep::Facets& facets);

}  // namespace cloud2csg::script
