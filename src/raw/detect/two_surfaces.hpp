#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "raw/detect/grow.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {

/// Points near one surface, on which a step is looked for. Successive points are near each other.
struct NearPoints {
  const WorkCloud& cloud;
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<double> distances;      ///< from the one surface
  double offset;              ///< median distance of the run of points that is likeliest to be off: about the height
  Points feet;                ///< the points moved onto the one surface
  NeighbourTable neighbours;  ///< among the feet
  double noise;
  AgreementLimits fit_limits;
};

/// The surface's points and free ones nearby. Absent if no run of points is off the surface, or if the points of a
/// round one scatter clearly more than the noise: facets would pass for steps. O(cloud + n log n) @throws Cancelled
[[nodiscard]] std::optional<NearPoints> near_points(const GrownSurface& grown, const WorkCloud& cloud,
                                                    const std::vector<bool>& is_free, const SearchLimits& limits,
                                                    const RunContext& run);

/// Two surfaces, and the one on which each point is.
struct TwoSurfaces {
  std::array<Surface, 2> surfaces;
  std::array<std::vector<double>, 2> distances;  ///< of all points from each
  std::vector<std::uint8_t> side;                ///< of each point: 0 or 1

  [[nodiscard]] double distance(std::size_t k) const { return distances[side[k]][k]; }
};

/// Share of the k_around points nearest to point k that are on its side.
[[nodiscard]] double share_on_own_side(const TwoSurfaces& two, const NearPoints& near, std::size_t k);

/// Negative logarithm of the likelihood of the points, each on its side, up to a constant. O(n)
[[nodiscard]] double cost_of(const TwoSurfaces& two, const NearPoints& near);

/// Two surfaces of the one's type that explain the points best; the second has fewer points. The neighbours of a point
/// choose its side without it, so that its own error does not speak for a step. Absent if none are found. O(n x
/// neighbours) @throws Cancelled
[[nodiscard]] std::optional<TwoSurfaces> fit_two(const Surface& one, const NearPoints& near, const RunContext& run);

}  // namespace cloud2csg
