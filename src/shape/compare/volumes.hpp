#pragma once

#include <optional>

#include "cloud2csg/compare.hpp"

namespace cloud2csg {

struct Volumes {
  std::optional<double> truth, result, common;  ///< absent where a shape has no volume
};

/// Volumes by columns over the joint bounds. A shape has no volume when it is a cloud, or a mesh with holes.
/// @throws Error for an unbounded solid; Cancelled.
[[nodiscard]] Volumes measure_volumes(const Shape3d& truth, const Shape3d& result, int resolution,
                                      const RunContext& run);

}  // namespace cloud2csg
