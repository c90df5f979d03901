#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/advanced/winding_number.hpp"
#include "raw/detect/surface_mixture.hpp"
#include "raw/detect/work_cloud.hpp"

namespace cloud2csg {

/// Surfaces whose points have a smaller share of neighbours on their own surface lie among each other's. Points of
/// large surfaces have 95 %. With 0.6, half of the narrow bores stay strips.
constexpr double k_own_share = 0.8;

/// The winding number of a cloud, and of all its points but some.
class CloudWinding {
 public:
  /// O(n log n)
  CloudWinding(const WorkCloud& cloud, const NeighbourTable& neighbours);

  /// Mean over the places. O(points log points + places log n)
  [[nodiscard]] double mean_without(std::span<const std::uint32_t> points,
                                    std::span<const Eigen::Vector3d> places) const;

 private:
  [[nodiscard]] WindingField field_of(std::span<const std::uint32_t> points) const;

  const WorkCloud& cloud_;
  std::vector<double> areas_;
  WindingField whole_;
};

/// The mixture with the sides of the material as most normals of its points say. Where these are arbitrary, or put two
/// planes that lie over each other on the same side, the winding number of all other points decides: within a bore or
/// gap, they say that there is material; within a pin or wall, none. `points`: those of the mixture's positions,
/// ascending. O(points log points + log n)
[[nodiscard]] SurfaceMixture oriented(SurfaceMixture mixture, std::span<const std::uint32_t> points,
                                      const WorkCloud& cloud, const CloudWinding& winding);

}  // namespace cloud2csg
