#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "core/base/random.hpp"
#include "raw/detect/agreement.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// The points [first, last), successive on the Z curve, within a ball.
struct PointRun {
  std::uint32_t first, last;
  Eigen::Vector3d middle;
  double radius;
  double precision;  ///< least of the points
};

/// A cloud for sampling: centred, scaled to a diagonal of 1 and sorted along a Z curve, so octree cells are runs.
struct WorkCloud {
  std::vector<OrientedPoint> points;
  std::vector<std::uint32_t> code;   ///< position on the curve, ascending: k_levels bits an axis
  std::vector<std::uint32_t> index;  ///< original index of each point
  std::vector<PointRun> runs;        ///< of all points, ascending
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double diagonal = 1;

  static constexpr int k_levels = 10;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  /// The points [first, last) in the octree cell of point i. The cell's edge is 2^-level of the cloud's longest. O(log
  /// n). Precondition: 0 <= level <= k_levels.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> cell_of(std::uint32_t i, int level) const;
  /// Diagonal of the points' bounding box. O(n)
  [[nodiscard]] double extent_of(const std::vector<std::uint32_t>& indices) const;
  /// Of all points. O(n)
  [[nodiscard]] Points positions() const;
  /// O(indices)
  [[nodiscard]] Points positions_of(const std::vector<std::uint32_t>& indices) const;
  /// The k_around nearest of each point. They stay while normals change. O(n log n) @throws Cancelled
  [[nodiscard]] NeighbourTable neighbours(const RunContext& run) const;
  /// At most `most` of the points, evenly spaced along the list.
  [[nodiscard]] std::vector<OrientedPoint> some_of(std::span<const std::uint32_t> indices, std::size_t most) const;
};

/// O(n log n). Precondition: the cloud has normals and points.
[[nodiscard]] WorkCloud make_work_cloud(const PointCloud& cloud);

/// Runs of points that are sorted along a Z curve. O(n)
[[nodiscard]] std::vector<PointRun> runs_of(std::span<const OrientedPoint> points);

/// Calls f(index, agreement) for each point on the surface of those with is_wanted(index), ascending. Skips runs that
/// are too far from the surface, since the distance of two points differs by no more than they are apart. O(n / 64) and
/// the points near the surface.
template <class IsWanted, class Function>
void for_each_agreeing(const Surface& surface, const WorkCloud& cloud, const AgreementLimits& limits,
                       const IsWanted& is_wanted, const Function& f) {
  with_agreement(surface, [&](const auto& rule) {
    for (const PointRun& run : cloud.runs) {
      const double distance = std::abs(rule({run.middle, surface.axis}).distance);
      if (distance > limits.distance / run.precision + run.radius) continue;
      for (std::uint32_t i = run.first; i < run.last; ++i) {
        if (!is_wanted(i)) continue;
        const Agreement agreement = rule(cloud.points[i]);
        if (limits.hold(agreement)) f(i, agreement);
      }
    }
  });
}

/// The points that no surface has taken yet.
class FreePoints {
 public:
  explicit FreePoints(const WorkCloud& cloud);

  [[nodiscard]] const WorkCloud& cloud() const { return cloud_; }
  [[nodiscard]] const std::vector<std::uint32_t>& list() const { return list_; }  ///< ascending
  [[nodiscard]] bool is_free(std::uint32_t i) const { return is_free_[i]; }
  [[nodiscard]] const OrientedPoint& operator[](std::uint32_t i) const { return cloud_.points[i]; }

  /// O(n)
  void take(std::span<const std::uint32_t> points);

  /// Draws `count` free points with repetition; fewer if fewer are free.
  [[nodiscard]] std::vector<OrientedPoint> draw(std::size_t count, RandomStream& random) const;
  /// A random point and others from an octree cell of random size around it: up to `count`, limited by free points.
  [[nodiscard]] std::vector<OrientedPoint> draw_neighbours(std::size_t count, RandomStream& random) const;

 private:
  const WorkCloud& cloud_;
  std::vector<bool> is_free_;
  std::vector<std::uint32_t> list_;
};

}  // namespace cloud2csg
