#pragma once

#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Points on the surfaces of primitives, with their own outward normals.
struct SurfaceSamples {
  PointCloud points = {};
  std::vector<double> area_of_sample;  ///< by primitive: what each of its samples stands for
};

/// So many a primitive, the same always. `region` bounds what is drawn of half-spaces. Uniform by area;
/// of expressions and displaced solids nearly so.
[[nodiscard]] SurfaceSamples sample_surfaces(const PrimitiveSet& primitives, const AlignedBox& region,
                                             std::size_t samples);

}  // namespace cloud2csg
