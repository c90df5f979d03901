#pragma once

#include <span>
#include <string>
#include <vector>

#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// The points' noise, and how far from a primitive and how tilted points on it may be.
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

/// Primitives that points support, with their indices in the input.
struct SupportedPrimitives {
  PrimitiveSet primitives;
  std::vector<PrimitiveIndex> original;
  std::vector<std::string> warnings = {};  ///< what was left out, in sentences for the user

  [[nodiscard]] std::size_t size() const { return primitives.size(); }
};

[[nodiscard]] SupportedPrimitives take_all(const PrimitiveSet& primitives);

/// Leaves out primitives without points, with a warning each; many share one. `points_of_primitive` counts each one's
/// points, by index in `supported`. @throws Error when no primitive has points
[[nodiscard]] SupportedPrimitives without_unsupported(SupportedPrimitives supported,
                                                      std::span<const std::size_t> points_of_primitive);

}  // namespace cloud2csg
