#pragma once

#include <vector>

#include "cloud2csg/sample.hpp"
#include "shape/sample/ray_caster.hpp"

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

}  // namespace cloud2csg
