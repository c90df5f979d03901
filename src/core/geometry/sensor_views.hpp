#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

/// Visibility from the sensors: where no sensor could see, missing points say nothing.
namespace cloud2csg {

/// How far each sensor saw in each direction. Sensors close to each other, as of a moving scanner, count as one.
class SensorViews {
 public:
  /// Precondition: the cloud has points and sensor positions. O(points log points)
  explicit SensorViews(const PointCloud& cloud);

  /// Points per area that a surface with this normal or its opposite would have at `place`. 0 where nearer surfaces
  /// hide it from all sensors, or these graze it. A sensor that saw nothing in that direction would have seen it.
  /// O(views)
  [[nodiscard]] double density_at(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;

  /// The same at a place that no point of the surface is near: there, a slightly nearer return in the same direction is
  /// not from that place, so only directions with returns from beyond it, or without any, tell that a sensor would have
  /// seen it. O(views)
  [[nodiscard]] double density_at_bare(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;

  /// The median density at some of the cloud's points, taken evenly along `order`, which holds all points.
  /// Precondition: the cloud has normals. O(views) @throws Cancelled
  [[nodiscard]] double usual_density(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                     const RunContext& run) const;

 private:
  /// The ranges of one sensor. A grid on an octahedron around the sensor bins the directions (Meyer et al. 2010).
  struct View {
    Eigen::Vector3d sensor;
    int resolution = 0;                ///< cells along a side of the square grid
    double width = 0;                  ///< angle that a cell spans, in radians
    double points_a_steradian = 0;     ///< mean over the cells with points
    std::vector<float> ranges;         ///< ranges cell by cell, ascending within each cell
    std::vector<std::uint32_t> first;  ///< by cell: where its ranges begin; one entry more for the end
  };
  /// The share of a sensor's returns in a direction that are no nearer than a surface at `range`. The surface itself
  /// may be nearer within a cell of the grid by `tangent` times the cell's width.
  [[nodiscard]] static double share_that_sees(const View& view, const Eigen::Vector3d& way, double range,
                                              double tangent);
  [[nodiscard]] double density(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, bool is_bare) const;
  [[nodiscard]] static View make_view(const PointCloud& cloud, std::span<const std::uint32_t> points);

  std::vector<View> views_;
};

/// Which points on surfaces sensors would see: all where the density is at least the cloud's median, fewer the lower it
/// is, none where hidden. All if the cloud has no sensor positions. Deterministic. `order`: see spatial_order().
[[nodiscard]] std::vector<bool> are_seen(const PointCloud& points, const PointCloud& cloud,
                                         std::span<const std::uint32_t> order, const RunContext& run);

}  // namespace cloud2csg
