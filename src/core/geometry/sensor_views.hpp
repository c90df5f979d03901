#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/run_context.hpp"

/// What the sensors could see: where they could not, the absence of points says nothing.
namespace cloud2csg {

/// How far each sensor saw in each direction. Sensors that stood near each other, as of a scanner that moves, are one.
class SensorViews {
 public:
  /// Precondition: the cloud has points and sensor positions. O(points log points)
  explicit SensorViews(const PointCloud& cloud);

  /// Points per area that a surface at this place, with this normal or the opposite one, would have: 0 where what is
  /// nearer hides it from all sensors, or these graze it. Where a sensor saw nothing at all, it would have seen the
  /// surface. O(views)
  [[nodiscard]] double density_at(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;

  /// The median of what the points of the cloud have, by some of them, evenly along `order`, which holds all. The cloud
  /// has normals. O(views) @throws Cancelled
  [[nodiscard]] double usual_density(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                     const RunContext& run) const;

 private:
  /// Directions are told apart by a grid on an octahedron (Meyer et al. 2010) around the sensor.
  struct View {
    Eigen::Vector3d sensor;
    int resolution = 0;                ///< of the grid, which is square
    double width = 0;                  ///< of a cell of it, an angle in radians
    double points_a_steradian = 0;     ///< where there are points
    std::vector<float> ranges;         ///< how far the sensor saw, cell by cell, ascending
    std::vector<std::uint32_t> first;  ///< by cell: where its ranges begin; and where the last one's end
  };
  /// Of what is seen in a direction, the share that is no nearer than a surface there.
  [[nodiscard]] static double share_that_sees(const View& view, const Eigen::Vector3d& way, double range,
                                              double cosine);
  [[nodiscard]] static View make_view(const PointCloud& cloud, std::span<const std::uint32_t> points);

  std::vector<View> views_;
};

/// Of points on surfaces, those that stand for what sensors see: all where a surface would have as many points as those
/// of the cloud have at the median, the fewer the less it would have, and none where it is hidden. All where the cloud
/// has no sensor positions. The same always. `order`: see spatial_order().
[[nodiscard]] std::vector<bool> are_seen(const PointCloud& points, const PointCloud& cloud,
                                         std::span<const std::uint32_t> order, const RunContext& run);

}  // namespace cloud2csg
