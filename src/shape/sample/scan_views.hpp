#pragma once

#include <optional>
#include <vector>

#include "cloud2csg/sample.hpp"
#include "shape/sample/ray_caster.hpp"

/// Where the virtual scanner stands, the rays of a view, and the errors of what they return.
namespace cloud2csg {

/// The bounding sphere of the part: what sensors look at, and the measure of their errors.
struct ScanTarget {
  Eigen::Vector3d middle;
  double radius;

  [[nodiscard]] double diagonal() const { return 2.0 * radius; }
};

struct View {
  Pose sensor;                     ///< in truth; the sensor looks along its own z axis
  Pose misplacement;               ///< from the truth to where the registration puts what this view sees
  double column_shift, row_shift;  ///< of the raster, in steps from 0 to 1
};

/// One view each in the directions of a Fibonacci spiral, which covers the sphere evenly for any number of them, or the
/// half of it above the table.
[[nodiscard]] std::vector<View> place_views(const ScanTarget& target, const ScanOptions& options);

/// The rays of a view: a square raster of equal angles, row by row, within the field of view.
struct Raster {
  double step;       ///< angle between neighbours, in radians
  std::size_t side;  ///< rays in a row, and rows

  [[nodiscard]] std::size_t size() const { return side * side; }
};

/// @throws Error when the step is so small that the rays cannot be counted.
[[nodiscard]] Raster make_raster(const ScanOptions& options, double step);

[[nodiscard]] Ray ray_of(const View& view, const Raster& raster, std::size_t index);

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
