#pragma once

#include "brep/opencascade/make_body.hpp"

namespace cloud2csg::brep {

struct Evaluation {
  Bodies bodies;
  std::size_t healed_faces = 0;
  std::vector<KernelFailure> failures = {};  ///< by node
};

/// The solid of a plan's root, in the kernel's frame. Nodes that do not depend on each other are made in parallel.
/// @throws Cancelled, and what the host throws
[[nodiscard]] Evaluation evaluate(const KernelJob& job, const KernelHost& host, SphereForm spheres);

}  // namespace cloud2csg::brep
