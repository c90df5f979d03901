#pragma once

#include <optional>
#include <vector>

#include "cloud2csg/sample.hpp"
#include "shape/sample/ray_caster.hpp"

/// Positions of the virtual scanner, the rays of a view, and the errors of their returns.
namespace cloud2csg {

/// The part's bounding sphere: the target of sensors and the unit of errors.
struct ScanTarget {
  Eigen::Vector3d middle;
  double radius;

  [[nodiscard]] double diagonal() const { return 2.0 * radius; }
};

struct View {
  Pose sensor;                     ///< true pose; the sensor looks along its own z axis
  Pose misplacement;               ///< from the true place of this view's points to the registered one
  double column_shift, row_shift;  ///< raster offset, in steps from 0 to 1
};

/// Views from a Fibonacci spiral, which evenly covers the sphere, or the half above the table, for any number.
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

/// Random choices for one ray. All are drawn for every ray, so that one defect does not change the others.
struct RayChances {
  RayChances(std::uint64_t seed, std::size_t view, std::size_t ray);

  double loss, outlier, mixing;  ///< each uniform in [0, 1): the defect occurs below its probability
  double outlier_place;          ///< uniform: position on the ray
  double mixing_weight;          ///< uniform: position between the two surfaces
  double beam_direction;         ///< uniform: on which side of the ray the rest of the beam is
  double noise;                  ///< standard normal
};

/// Probability that a hit returns nothing; 0 up to the grazing angle.
[[nodiscard]] double loss_probability(const ScanOptions& options, const Ray& ray, const RayHit& hit);

/// Standard deviation of a hit's range, in world units.
[[nodiscard]] double noise_sigma(const ScanOptions& options, const ScanTarget& target, const Ray& ray,
                                 const RayHit& hit);

/// A ray on the border of the beam around `ray`. The beam's radius is a quarter of the step.
[[nodiscard]] Ray beam_side(const Ray& ray, double step, const RayChances& chances);

/// The measured range of a hit: with noise, as an outlier, or mixed with the hit at the side of the beam.
[[nodiscard]] double measured_range(const ScanOptions& options, const ScanTarget& target, const Ray& ray,
                                    const RayHit& hit, const std::optional<RayHit>& side, double step,
                                    const RayChances& chances);

}  // namespace cloud2csg
