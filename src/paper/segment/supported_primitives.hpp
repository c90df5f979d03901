#pragma once

#include <span>
#include <string>
#include <vector>

#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/primitive.hpp"

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

/// Primitives that points support, and which of the input's each is.
struct SupportedPrimitives {
  PrimitiveSet primitives;
  std::vector<PrimitiveIndex> original;
  std::vector<std::string> warnings = {};  ///< sentences for the user: what was left out

  [[nodiscard]] std::size_t size() const { return primitives.size(); }
};

/// All of them.
[[nodiscard]] SupportedPrimitives take_all(const PrimitiveSet& primitives);

/// Leaves out those without points, with a warning each; many share one. The same object when there are none.
/// `points_of_primitive`: how many points each has, by index in `supported`.
/// @throws Error when no primitive has points
[[nodiscard]] SupportedPrimitives without_unsupported(SupportedPrimitives supported,
                                                      std::span<const std::size_t> points_of_primitive);

}  // namespace cloud2csg
