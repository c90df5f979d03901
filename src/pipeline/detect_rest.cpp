#include "pipeline/detect_rest.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace cloud2csg {
namespace {

std::vector<std::uint32_t> points_of_none(const std::vector<SurfacePoints>& known, std::size_t count) {
  std::vector<bool> is_taken(count, false);
  for (const SurfacePoints& own : known) {
    for (const std::uint32_t i : own.points) is_taken[i] = true;
  }
  std::vector<std::uint32_t> rest;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!is_taken[i]) rest.push_back(i);
  }
  return rest;
}

}  // namespace

SegmentationTolerances tolerances_of(const DetectOptions& options, const Scale& scale) {
  return {.distance = detection_tolerance(options, scale),
          .cosine = std::cos(options.angle_tolerance_deg * std::numbers::pi / 180)};
}

RestDetection detect_rest(const PointCloud& cloud, const Scale& scale, const PrimitiveSet& known,
                          const DetectOptions& options, const RunContext& run) {
  if (known.empty()) return {.known = {}, .detection = detect_surfaces(cloud, scale, options, run)};
  RestDetection result{.known = deal_points(cloud, known, tolerances_of(options, scale), run), .detection = {}};
  const std::vector<std::uint32_t> rest = points_of_none(result.known, cloud.size());
  DetectOptions of_rest = options;
  of_rest.distance_tolerance = detection_tolerance(options, scale);
  of_rest.least_points = detection_least_points(options, cloud.size());
  if (rest.empty()) {
    result.detection.distance_tolerance = *of_rest.distance_tolerance;
    return result;
  }
  result.detection = detect_surfaces(select_points(cloud, rest), scale, of_rest, run);
  for (DetectedSurface& surface : result.detection.surfaces) {
    for (std::uint32_t& i : surface.points) i = rest[i];
  }
  return result;
}

}  // namespace cloud2csg
