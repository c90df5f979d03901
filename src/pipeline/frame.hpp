#pragma once

#include "cloud2csg/extract.hpp"
#include "core/geometry/frame.hpp"

/// Extractions in the cloud's own frame: see frame_origin().
namespace cloud2csg {

[[nodiscard]] PrimitiveSet seen_from(PrimitiveSet primitives, const Eigen::Vector3d& origin);

/// A result of the frame in the coordinates of the given cloud. The first primitives, those that were given and did not
/// move, are as they were given, to the last bit.
[[nodiscard]] Extraction moved_back(Extraction result, const Eigen::Vector3d& origin, const PrimitiveSet& given);

}  // namespace cloud2csg
