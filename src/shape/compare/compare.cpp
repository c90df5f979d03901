#include "cloud2csg/compare.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "shape/compare/surfaces.hpp"
#include "shape/compare/volumes.hpp"

namespace cloud2csg {
namespace {

void check_shape(const Shape3d& shape, const char* role) {
  const auto fail = [role](const char* expected, const char* remedy) {
    throw Error({.where = role, .expected = expected, .remedy = remedy});
  };
  const int kinds = (shape.model ? 1 : 0) + (shape.mesh ? 1 : 0) + (shape.cloud ? 1 : 0);
  if (kinds != 1) fail("expected one of a model, a mesh and a point cloud", "");
  if (shape.model && !shape.model->tree) fail("the model has no tree, only primitives", "run extract on it first");
  if (shape.cloud && shape.cloud->size() == 0) fail("the point cloud is empty", "");
  if (shape.mesh && shape.mesh->triangles.empty()) fail("the mesh is empty", "");
}

struct OneSided {
  double mean = 0.0;
  double largest = 0.0;
};

OneSided summarise(const std::vector<double>& distances) {
  OneSided sides;
  for (const double distance : distances) {
    sides.mean += distance / static_cast<double>(distances.size());
    sides.largest = std::max(sides.largest, distance);
  }
  return sides;
}

std::optional<double> ratio(std::size_t result, std::size_t truth) {
  if (result == truth) return 1.0;  // of two single leaves too, whose depth is 0
  if (truth == 0) return std::nullopt;
  return static_cast<double>(result) / static_cast<double>(truth);
}

}  // namespace

Comparison compare(const Shape3d& truth, const Shape3d& result, const CompareOptions& options, const RunContext& run) {
  validate(options);
  check_shape(truth, "truth");
  check_shape(result, "result");
  Comparison comparison;
  if (truth.model && result.model) {
    comparison.size_ratio = ratio(result.model->tree->size(), truth.model->tree->size());
    comparison.depth_ratio = ratio(depth(*result.model->tree), depth(*truth.model->tree));
  }
  constexpr std::size_t k_steps = 3;
  run.report("compare", 0, k_steps);
  const Volumes volumes = measure_volumes(truth, result, options.resolution, run);
  comparison.volume_truth = volumes.truth;
  comparison.volume_result = volumes.result;
  if (volumes.common) {
    const double joined = *volumes.truth + *volumes.result - *volumes.common;
    if (joined > 0.0) comparison.intersection_over_union = *volumes.common / joined;
  }
  run.report("compare", 1, k_steps);
  const OneSided forth = summarise(distances_to(result, surface_points(truth, options, run), run));
  run.report("compare", 2, k_steps);
  const OneSided back = summarise(distances_to(truth, surface_points(result, options, run), run));
  run.report("compare", k_steps, k_steps);
  comparison.mean_distance = 0.5 * (forth.mean + back.mean);
  comparison.hausdorff_distance = std::max(forth.largest, back.largest);
  return comparison;
}

}  // namespace cloud2csg
