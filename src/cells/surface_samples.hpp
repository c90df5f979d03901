#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// Points on the surfaces of primitives, with their own outward normals.
struct SurfaceSamples {
  PointCloud points = {};
  std::vector<double> area_of_sample;  ///< by primitive: the area of each of its samples
};

/// Deterministic for any number of threads. `boxes` hold the primitives' surfaces, one each. `region` bounds the
/// samples of half-spaces. Uniform by area; nearly so for expressions and displaced solids.
[[nodiscard]] SurfaceSamples sample_surfaces(const PrimitiveSet& primitives, std::span<const AlignedBox> boxes,
                                             const AlignedBox& region, const SampleCounts& counts,
                                             const RunContext& run = {});

}  // namespace cloud2csg
