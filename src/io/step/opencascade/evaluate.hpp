#pragma once

#include <functional>

#include "io/step/opencascade/make_body.hpp"

namespace cloud2csg::brep {

struct Evaluation {
  Bodies bodies;
  std::size_t healed_faces = 0;
  std::vector<KernelFailure> failures = {};  ///< by node
};

/// Whether the solid of a node is the same when it is read from a file. Called from several threads at a time.
using FileTest = std::function<bool(std::size_t node, const Bodies& bodies)>;

/// The solid of a plan's root, in the kernel's frame. Nodes that do not depend on each other are made in parallel.
/// What a test, if there is one, does not let pass counts as failed, as an invalid result does.
/// @throws Cancelled, and what the host throws
[[nodiscard]] Evaluation evaluate(const KernelJob& job, const KernelHost& host, SphereForm spheres,
                                  const FileTest& file_test = {});

}  // namespace cloud2csg::brep
