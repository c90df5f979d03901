#pragma once

#include <optional>

#include "shape/sample/scan_views.hpp"

namespace cloud2csg {

/// What chance decides about one ray. All of it is drawn for every ray, so that one defect does not change the others.
struct RayChances {
  RayChances(std::uint64_t seed, std::size_t view, std::size_t ray);

  double loss, outlier, mixing;  ///< each uniform in [0, 1): the defect occurs below its probability
  double outlier_place;          ///< uniform: where on the ray
  double mixing_weight;          ///< uniform: how far from the one surface to the other
  double beam_direction;         ///< uniform: which side of the ray the rest of the beam is on
  double noise;                  ///< standard normal
};

/// Probability that a hit returns nothing; 0 up to the grazing angle.
[[nodiscard]] double loss_probability(const ScanOptions& options, const Ray& ray, const RayHit& hit);

/// Sigma of the range of a hit, in units of the world.
[[nodiscard]] double noise_sigma(const ScanOptions& options, const ScanTarget& target, const Ray& ray,
                                 const RayHit& hit);

/// A ray on the border of the beam around another one, whose radius is a quarter of the step.
[[nodiscard]] Ray beam_side(const Ray& ray, double step, const RayChances& chances);

/// The range that is measured for a hit, with noise, as an outlier, or between it and what the side of the beam hits.
[[nodiscard]] double measured_range(const ScanOptions& options, const ScanTarget& target, const Ray& ray,
                                    const RayHit& hit, const std::optional<RayHit>& side, double step,
                                    const RayChances& chances);

}  // namespace cloud2csg
