#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "support/random_scene.hpp"

/// A random scene with the tables made from it.
namespace cloud2csg::test {

inline constexpr double k_scene_noise = 0.02;

inline SegmentationTolerances scene_tolerances() {
  return segmentation_tolerances({}, k_scene_noise);
}

/// The weights that matter: derived from the noise, the paper's, ones for which even the far side of a surface counts.
inline std::vector<ObjectiveOptions> all_weights() {
  return {ObjectiveOptions{}, ObjectiveOptions{.alpha = {}, .beta = 100, .gamma = 18 / std::numbers::pi},
          ObjectiveOptions{.alpha = 0.5, .beta = 1.5, .gamma = 1.0}};
}

struct Scene {
  PrimitiveSet primitives;
  PointCloud cloud;
};

inline Scene random_scene(std::size_t primitives, std::size_t points, RandomStream& random) {
  Scene scene{.primitives = random_primitives(primitives, random), .cloud = {}};
  scene.cloud = random_cloud(scene.primitives, points, random);
  return scene;
}

inline std::vector<PrimitiveIndex> all_of(const PrimitiveSet& primitives) {
  std::vector<PrimitiveIndex> all(primitives.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  return all;
}

/// In full precision unless told otherwise, so that it may be held against the reference.
inline PointPass pass_over(const Scene& scene, const std::vector<RankClassesRequest>& requests,
                           const ObjectiveOptions& weights = {}, int threads = 1,
                           Precision precision = Precision::full) {
  return build_rank_classes(
      scene.cloud, scene.primitives, requests,
      {.tolerances = scene_tolerances(), .objective = weights, .noise = k_scene_noise, .precision = precision},
      {.threads = threads});
}

/// One table over all primitives and all points.
inline RankClasses whole_table(const Scene& scene, const ObjectiveOptions& weights = {}, int threads = 1,
                               Precision precision = Precision::full) {
  return pass_over(scene, {{.primitives = all_of(scene.primitives), .all_points = true}}, weights, threads, precision)
      .tables.front();
}

/// Trees from a single leaf to many more leaves than primitives.
inline std::vector<CsgTree> random_formulas(std::size_t primitives, std::size_t count, RandomStream& random) {
  std::vector<CsgTree> trees{CsgTree::leaf(0), complement(CsgTree::leaf(random.below(primitives)))};
  while (trees.size() < count) {
    trees.push_back(random_formula(primitives, 1 + random.below(2 * std::min<std::size_t>(primitives, 40)), random));
  }
  return trees;
}

}  // namespace cloud2csg::test
