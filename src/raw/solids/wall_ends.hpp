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
/// face up. Ends higher than `foot` are left out unless two sensors see the place just below: they would have seen the
/// wall go on. A rounded edge is no end: nobody sees it turn below. Precondition: the cloud has sensor positions.
/// O(n + ends x sensors x bins along a line)
[[nodiscard]] std::vector<WallEnd> wall_ends(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                             const FloorBins& bins, double foot);

/// The height at which most of the walls end, if there is one. O(n log n)
[[nodiscard]] std::optional<double> common_end(std::vector<double> heights, double step);

/// Those of the candidates whose nearest end, of those with the bin on the inner side of their wall, is higher than
/// `foot`. O(candidates log ends)
[[nodiscard]] std::vector<std::uint32_t> bins_behind(const std::vector<WallEnd>& ends, const FloorBins& bins,
                                                     double foot, const std::vector<std::uint32_t>& candidates);

}  // namespace cloud2csg
