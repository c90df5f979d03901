#pragma once

#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/segmentation.hpp"

namespace cloud2csg {

struct RestDetection {
  std::vector<SurfacePoints> known;  ///< the points on each known primitive
  Detection detection;               ///< of the others, as indices into the whole cloud
};

/// The tolerances by which points lie on solids, when they are those of the detection.
[[nodiscard]] SegmentationTolerances tolerances_of(const DetectOptions& options, const Scale& scale);

/// Deals points out to the primitives that are known and detects surfaces in the rest: detect_surfaces(), with the
/// limits that hold for the whole cloud. The same as that where nothing is known.
/// Precondition: the cloud has normals and points. @throws Error, Cancelled
[[nodiscard]] RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                                        const DetectOptions& options, const RunContext& run);

}  // namespace cloud2csg
