#pragma once

#include <cstdint>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

struct SampleOptions {
  std::size_t count = 10'000;   ///< points to make; used when density is 0
  double density = 0.0;         ///< points per unit of area; 0 = use count
  double noise = 0.0;           ///< sigma of the Gaussian displacement of each coordinate (the paper: 0.01)
  double normal_noise_deg = 0;  ///< sigma of the angle by which normals are tilted
  std::uint64_t seed = 1;
};

/// Points on a model's surface: uniform by area, only where the primitives' surfaces are the surface of the whole
/// solid, with outward normals. Positions are moved by the noise after the normal was taken.
/// @throws Error when the solid is empty or unbounded; Cancelled.
[[nodiscard]] PointCloud sample_surface(const CsgTree& tree, const PrimitiveSet& primitives,
                                        const SampleOptions& options = {}, const RunContext& run = {});

/// Moves each coordinate by a Gaussian of this sigma, in the cloud's units; normals stay. The same seed moves the same
/// way. O(n)
[[nodiscard]] PointCloud with_noise(PointCloud cloud, double sigma, std::uint64_t seed = 1);

}  // namespace cloud2csg
