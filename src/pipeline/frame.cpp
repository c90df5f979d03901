#include "pipeline/frame.hpp"

#include <utility>

namespace cloud2csg {

PrimitiveSet seen_from(PrimitiveSet primitives, const Eigen::Vector3d& origin) {
  for (Primitive& primitive : primitives) primitive.pose.position -= origin;
  return primitives;
}

Extraction moved_back(Extraction result, const Eigen::Vector3d& origin, const PrimitiveSet& given) {
  result.cloud = seen_from(std::move(result.cloud), -origin);
  for (DetectedSurface& found : result.surfaces) found.surface.position += origin;
  for (UnexplainedRegion& region : result.statistics.verdict.regions) region.place += origin;
  if (result.statistics.finding) {
    for (ClosedSurface& closed : result.statistics.finding->closed) closed.place += origin;
  }
  result.model.primitives = seen_from(std::move(result.model.primitives), -origin);
  for (std::size_t k = 0; k < given.size(); ++k) result.model.primitives[k].pose = given[k].pose;
  return result;
}

}  // namespace cloud2csg
