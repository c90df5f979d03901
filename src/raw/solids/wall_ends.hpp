#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "raw/solids/floor_bins.hpp"

namespace cloud2csg {

/// Where an upright wall ends at the bottom, in the frame of the bins.
struct WallEnd {
  Eigen::Vector3d place;
  Eigen::Vector2d outward;  ///< unit length
};

/// Ends of upright planes and cylinders: one for each bin in which such a surface has the lowest point that does not
/// face up. If an end is higher than `foot`, a sensor would have seen the wall go on. A rounded edge is no end: nobody
/// sees it turn below. Precondition: the cloud has sensor positions. O(n + bins x sensors)
[[nodiscard]] std::vector<WallEnd> wall_ends(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                             const FloorBins& bins, double foot);

/// The height at which most of the walls end, if there is one. O(n log n)
[[nodiscard]] std::optional<double> common_end(std::vector<double> heights, double step);

/// Bins behind a wall that ends higher than `foot`, before any other wall does. O(bins log ends)
[[nodiscard]] std::vector<std::uint32_t> bins_behind(const std::vector<WallEnd>& ends, const FloorBins& bins,
                                                     double foot);

}  // namespace cloud2csg
