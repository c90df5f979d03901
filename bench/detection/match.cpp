#include "detection/match.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "cloud2csg/error.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;

/// The point's index in the cloud for each prepared point. Preparation keeps order and positions.
std::vector<std::uint32_t> indices_before(const PointCloud& cloud, const PointCloud& prepared) {
  std::vector<std::uint32_t> indices;
  std::uint32_t i = 0;
  for (std::size_t k = 0; k < prepared.size(); ++k, ++i) {
    while (cloud.positions[i] != prepared.positions[k]) ++i;
    indices.push_back(i);
  }
  return indices;
}

bool is_alike(const Scene& scene, std::uint32_t true_index, const Surface& found) {
  const Surface& truth = scene.surfaces[true_index];
  if (found.type != truth.type || found.concave != truth.concave) return false;
  std::size_t near = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < scene.exact.size(); ++i) {
    if (scene.surface[i] != true_index) continue;
    const Vector3d place = scene.exact[i];
    const bool is_near = std::abs(signed_distance(found, place)) <= std::hypot(scene.noise[i], scene.misalignment);
    near += is_near && normal(found, place).dot(normal(truth, place)) > 0 ? 1U : 0U;
    ++all;
  }
  return 2 * near >= all;
}

bool is_match(const Scene& scene, std::uint32_t true_index, const DetectedSurface& found) {
  constexpr double k_least_share = 0.4;
  const auto all = static_cast<double>(std::ranges::count(scene.surface, true_index));
  const auto own = static_cast<double>(
      std::ranges::count_if(found.points, [&](std::uint32_t i) { return scene.surface[i] == true_index; }));
  return own > 0 && own >= k_least_share * all && is_alike(scene, true_index, found.surface);
}

/// Whether each of the true surfaces can have a match of its own that is not taken.
bool can_be_matched(const Scene& scene, std::span<const std::uint32_t> true_indices,
                    std::span<const DetectedSurface> found, const std::set<std::size_t>& taken) {
  if (true_indices.empty()) return true;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (taken.contains(k) || !is_match(scene, true_indices.front(), found[k])) continue;
    std::set<std::size_t> more = taken;
    more.insert(k);
    if (can_be_matched(scene, true_indices.subspan(1), found, more)) return true;
  }
  return false;
}

}  // namespace

PointCloud with_true_normals(const Scene& scene) {
  PointCloud cloud = scene.cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t s = scene.surface[i];
    cloud.normals.push_back(s == k_no_surface ? Vector3d(Vector3d::UnitZ())
                                              : normal(scene.surfaces[s], scene.exact[i]));
  }
  return cloud;
}

std::vector<DetectedSurface> detect_by_default(const PreparedCloud& prepared) {
  return detect_surfaces(prepared.cloud, prepared.scale).surfaces;
}

std::vector<DetectedSurface> find_surfaces(const PointCloud& cloud, const Detector& detector) {
  try {
    const PreparedCloud prepared = prepare_cloud(cloud);
    const std::vector<std::uint32_t> before = indices_before(cloud, prepared.cloud);
    std::vector<DetectedSurface> found = detector(prepared);
    for (DetectedSurface& surface : found) {
      for (std::uint32_t& i : surface.points) i = before[i];
    }
    return found;
  } catch (const Error&) {
    return {};
  }
}

bool is_answered(const Scene& scene, const Question& question, std::span<const DetectedSurface> found) {
  return can_be_matched(scene, question.surfaces, found, {});
}

std::size_t count_unmatched(const Scene& scene, std::span<const DetectedSurface> found) {
  const auto is_unmatched = [&](const DetectedSurface& surface) {
    for (std::uint32_t s = 0; s < scene.surfaces.size(); ++s) {
      if (is_match(scene, s, surface)) return false;
    }
    return true;
  };
  return static_cast<std::size_t>(std::ranges::count_if(found, is_unmatched));
}

}  // namespace cloud2csg::bench
