#pragma once

#include <span>
#include <vector>

#include "cloud2csg/advanced/cells.hpp"

namespace cloud2csg {

/// Points on the surfaces of primitives, with their own outward normals.
struct SurfaceSamples {
  PointCloud points = {};
  std::vector<double> area_of_sample;  ///< by primitive: what each of its samples stands for
};

/// The same always, for any number of threads. `boxes` hold the primitives' surfaces, one each; `region` bounds what is
/// drawn of half-spaces. Uniform by area; of expressions and displaced solids nearly so.
[[nodiscard]] SurfaceSamples sample_surfaces(const PrimitiveSet& primitives, std::span<const AlignedBox> boxes,
                                             const AlignedBox& region, const SampleCounts& counts,
                                             const RunContext& run = {});

}  // namespace cloud2csg
