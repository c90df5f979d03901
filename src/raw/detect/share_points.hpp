#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Gives each surface all agreeing points, whoever found them first: the true surface of a face gets all of it.
/// @returns the points' distances, by surface
std::vector<std::vector<double>> claim_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, const RunContext& run);

/// Deals points out to the surfaces that they agree with. `cloud` and `limits` must outlive this object.
class PointSharing {
 public:
  /// O(points log points)
  PointSharing(const WorkCloud& cloud, const AgreementLimits& limits);

  /// Gives each point to one of the surfaces that it agrees with: to the one on which the point and those around it are
  /// likeliest. By its own distance alone, two surfaces less than six standard deviations apart would each lose the
  /// points on the other's side, and move apart. In an exact cloud, the own distance decides. Surfaces with fewer than
  /// `least` points are dropped. O(points x surfaces) @throws Cancelled
  [[nodiscard]] std::vector<GrownSurface> shared(std::vector<GrownSurface> surfaces, std::size_t least,
                                                 const RunContext& run) const;

 private:
  const WorkCloud& cloud_;
  const AgreementLimits& limits_;
  Points positions_;
  NeighbourTree tree_;
};

}  // namespace cloud2csg
