#pragma once

#include "cloud2csg/mesh.hpp"
#include "io/step/kernel.hpp"

namespace cloud2csg::brep {

[[nodiscard]] bool has_exact_surfaces(const Primitive& primitive);

/// The primitive in the kernel's frame. A half-space becomes a block with its face on top that otherwise reaches beyond
/// `extent` (in the model's frame). Precondition: has_exact_surfaces(primitive).
[[nodiscard]] KernelSolid kernel_solid(const Primitive& primitive, const AlignedBox& extent, const WorkFrame& frame);

[[nodiscard]] Facets kernel_facets(const TriangleMesh& mesh, const WorkFrame& frame);

/// The work frame for this extent: the model's own frame if its size fits a part in millimetres.
[[nodiscard]] WorkFrame work_frame(const AlignedBox& extent);

[[nodiscard]] AlignedBox to_kernel(const AlignedBox& box, const WorkFrame& frame);

}  // namespace cloud2csg::brep
