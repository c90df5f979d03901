#pragma once

#include "cloud2csg/mesh.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

/// Whether a primitive has surfaces that a kernel knows.
[[nodiscard]] bool has_exact_surfaces(const Primitive& primitive);

/// The primitive as the kernel is to make it, in the kernel's frame. A half-space becomes a block whose top is its face
/// and which reaches beyond `extent` (in the model's frame) everywhere else.
/// Precondition: has_exact_surfaces(primitive).
[[nodiscard]] KernelSolid kernel_solid(const Primitive& primitive, const AlignedBox& extent, const WorkFrame& frame);

/// A mesh in the kernel's frame.
[[nodiscard]] Facets kernel_facets(const TriangleMesh& mesh, const WorkFrame& frame);

/// The frame for a model of this extent: the model's own where its size is that of a part in millimetres.
[[nodiscard]] WorkFrame work_frame(const AlignedBox& extent);

[[nodiscard]] AlignedBox to_kernel(const AlignedBox& box, const WorkFrame& frame);

}  // namespace cloud2csg::brep
