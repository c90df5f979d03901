#pragma once

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/mesh.hpp"
#include "cloud2csg/model.hpp"
#include "view/picture/view.hpp"

namespace cloud2csg {

/// A colour as linear numbers.
[[nodiscard]] Eigen::Vector3f linear_colour(const Colour& colour);

/// How bright a surface with this unit normal is, from 0 to 1: light from over the camera's left shoulder, and a little
/// from the sky.
[[nodiscard]] float brightness(const Eigen::Vector3d& normal, const View& view);

/// The model's solid, whose surface `mesh` is, but for rounding. The model must have a tree. @throws Cancelled
[[nodiscard]] Samples draw_solid(const Model& model, const TriangleMesh& mesh, const View& view, const RunContext& run);

}  // namespace cloud2csg
