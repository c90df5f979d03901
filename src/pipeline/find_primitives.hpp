#pragma once

#include <string>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/reconstruct.hpp"

namespace cloud2csg {

struct RestDetection {
  std::vector<SurfacePoints> known;  ///< the points on each known primitive
  Detection detection;               ///< of the others, as indices into the whole cloud
};

/// Deals points out to the primitives that are known and detects surfaces in the rest: detect_surfaces(), with the
/// limits that hold for the whole cloud. The same as that where nothing is known.
/// Precondition: the cloud has normals and points. @throws Error, Cancelled
[[nodiscard]] RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                                        const DetectOptions& options, const RunContext& run);

/// What find_primitives() found, with all that is known on the way.
struct FoundPrimitives {
  PreparedCloud prepared;        ///< the cloud that everything else speaks of
  Detection detection;           ///< the surfaces that it lies on, beyond what lies on known primitives
  std::size_t added_points = 0;  ///< on what was not seen, a side or walls: the last ones of the cloud
  SolidChoice choice;            ///< those known, a few solids that surfaces bound, with evidence, and a tree over them
  std::vector<SurfacePoints> points;  ///< of the prepared cloud, that lie on each of these solids
  double detect_seconds = 0, choose_seconds = 0;
  std::vector<std::string> warnings;  ///< sentences for the user: what is doubtful, and where
};

/// find_primitives() without a word on known primitives that are not used. The time limit of the extraction holds: the
/// choice of solids has a tree to give at any time.
[[nodiscard]] FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options,
                                           const RunContext& run);

[[nodiscard]] FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t known, std::size_t raw_points);

}  // namespace cloud2csg
