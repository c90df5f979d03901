#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raw/detect/grow.hpp"

namespace cloud2csg {

/// Distance over which a program has smoothed the points, such as one that joins the views of a scanner into a mesh:
/// the errors of points so far apart correlate with 1/e. 0 if the errors are independent, or correlate over more than
/// some spacings, as form errors do. Rings of neighbours on the largest plane must lie on a Gaussian; 0 if no plane
/// is large enough. O(n log n)
[[nodiscard]] double smoothing_length(const std::vector<GrownSurface>& surfaces, const WorkCloud& cloud, double noise);

/// The surfaces without those that have no group of points of their own: all others lie at edges of larger surfaces, or
/// on these. Smoothing rounds edges, and within its length nothing tells a chamfer or fillet from a sharp edge. Largest
/// first. O(surfaces x points within the length x some hundred) @throws Cancelled
[[nodiscard]] std::vector<GrownSurface> without_smoothed_edges(std::vector<GrownSurface> surfaces,
                                                               const WorkCloud& cloud, double length,
                                                               const SearchLimits& limits, const RunContext& run);

/// Those of the points that are within 1.25 lengths of two surfaces that meet at an angle there. O(points x points
/// within the length) @throws Cancelled
[[nodiscard]] std::vector<std::uint32_t> points_at_edges(std::span<const std::uint32_t> points,
                                                         const std::vector<GrownSurface>& surfaces,
                                                         const WorkCloud& cloud, double length, const RunContext& run);

}  // namespace cloud2csg
