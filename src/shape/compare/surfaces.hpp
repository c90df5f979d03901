#pragma once

#include <vector>

#include "cloud2csg/compare.hpp"

namespace cloud2csg {

/// Points on a shape's surface: drawn uniformly by area, or the cloud as it is. The same for the same seed.
/// @throws Error for a solid without surface; Cancelled.
[[nodiscard]] Points surface_points(const Shape3d& shape, const CompareOptions& options, const RunContext& run);

/// The distance of each point to a shape's surface. Exact for meshes. For models exact where the foot of the
/// perpendicular onto the nearest primitive is on the surface, else to a mesh of the model (about 1e-5 of its size
/// too large or small where it is curved). For clouds the distance to the nearest point.
[[nodiscard]] std::vector<double> distances_to(const Shape3d& shape, const Points& points, const RunContext& run);

}  // namespace cloud2csg
