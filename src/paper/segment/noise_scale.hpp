#pragma once

#include "cloud2csg/advanced/segmentation.hpp"

namespace cloud2csg {

/// How exact the points are, and how far from a primitive they may be to be on it.
struct NoiseScale {
  double noise;
  SegmentationTolerances tolerances;
};

/// Precondition: the cloud has normals. Complexity: that of estimate_noise().
[[nodiscard]] inline NoiseScale measure_noise_scale(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                    const SegmentationOptions& options, const RunContext& run) {
  const double noise = estimate_noise(cloud, primitives, options.angle_tolerance_deg, run);
  return {.noise = noise, .tolerances = segmentation_tolerances(options, noise)};
}

}  // namespace cloud2csg
