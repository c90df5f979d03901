#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/reconstruct.hpp"

namespace cloud2csg {

struct RestDetection {
  std::vector<SurfacePoints> known;
  Detection detection;  ///< surfaces of the other points, as indices into the whole cloud
};

/// Assigns points to known primitives and runs detect_surfaces() on the others, with limits for the whole cloud.
/// Precondition: the cloud has normals and points. @throws Error, Cancelled
[[nodiscard]] RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                                        const DetectOptions& options, const RunContext& run);

/// The result of find_primitives() with its intermediate results, in the cloud's own frame.
struct FoundPrimitives {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< of the frame: see frame_origin()
  PreparedCloud prepared;                            ///< the cloud that all other members refer to
  Detection detection;                               ///< surfaces of the points on no known primitive
  std::vector<std::uint32_t> unexplained;            ///< points on no surface and no known primitive, ascending
  std::vector<double> areas = {};          ///< of the surface around each point of the cloud; empty if not measured
  std::vector<ClosedSurface> closed = {};  ///< where nobody saw the part
  PointCloud added = {};                   ///< points on these surfaces, which are not in the cloud
  SolidChoice choice;                      ///< known solids, chosen solids with evidence, and a tree over them
  std::optional<Error> no_solid;           ///< why the surfaces bound no solid; `choice` has no tree then
  std::vector<SurfacePoints> points;       ///< points of the prepared cloud on each solid
  double detect_seconds = 0, choose_seconds = 0;
  std::vector<std::string> warnings;  ///< sentences for the user, with places
};

/// find_primitives() without warnings about unused known primitives. Gives a tree if the time limit ends the choice.
[[nodiscard]] FoundPrimitives find_in_time(const PointCloud& cloud, const ReconstructOptions& options,
                                           const RunContext& run);

[[nodiscard]] FindingStatistics statistics_of(const FoundPrimitives& found, std::size_t known, std::size_t raw_points);

}  // namespace cloud2csg
