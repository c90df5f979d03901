#pragma once

#include <functional>

#include "io/step/opencascade/make_body.hpp"

namespace cloud2csg::brep {

struct Evaluation {
  Bodies bodies;
  std::size_t healed_faces = 0;
  std::vector<KernelFailure> failures = {};  ///< by node
};

/// Whether a node's solid survives writing and reading a file. Called concurrently from several threads.
using FileTest = std::function<bool(std::size_t node, const Bodies& bodies)>;

/// The solid of a plan's root, in the kernel's frame. Evaluates independent nodes in parallel. A result that is invalid
/// or fails `file_test` (if given) counts as failed. @throws Cancelled, and what the host throws
[[nodiscard]] Evaluation evaluate(const KernelJob& job, const KernelHost& host, SphereForm spheres,
                                  const FileTest& file_test = {});

}  // namespace cloud2csg::brep
