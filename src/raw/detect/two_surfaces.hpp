#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/random.hpp"
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
  NeighbourTable neighbours;  ///< among the feet of the points for the fit
  double noise;
  AgreementLimits fit_limits;

  /// Two surfaces are found by these, and tested by the others. A random half: if every other point were for the fit,
  /// each would have a neighbour with a similar error among the others.
  static bool is_for_fit(std::size_t k) { return mix(k) % 2 == 0; }
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

/// Share of the k_around points for the fit nearest to point k that are on its side.
[[nodiscard]] double share_on_own_side(const TwoSurfaces& two, const NearPoints& near, std::size_t k);

/// Two surfaces of the one's type that explain the points for the fit best; the second has fewer points. Absent if none
/// are found. O(n x neighbours) @throws Cancelled
[[nodiscard]] std::optional<TwoSurfaces> fit_two(const Surface& one, const NearPoints& near, const RunContext& run);

/// The two, fitted to all points that are clear of the other side. O(n)
[[nodiscard]] std::optional<TwoSurfaces> with_fits_to_all(TwoSurfaces two, const NearPoints& near);

}  // namespace cloud2csg
