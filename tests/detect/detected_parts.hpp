#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "core/base/random.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

/// Parts whose surfaces are known, and what detection finds on clouds of them.
namespace cloud2csg::test {

struct Part {
  PrimitiveSet primitives;
  CsgTree tree;
};

inline CsgTree first_without_others(const PrimitiveSet& primitives) {
  CsgTree tree = CsgTree::leaf(0);
  for (PrimitiveIndex p = 1; p < primitives.size(); ++p) tree = subtract(tree, CsgTree::leaf(p));
  return tree;
}

inline Part without_others(PrimitiveSet primitives) {
  CsgTree tree = first_without_others(primitives);
  return {.primitives = std::move(primitives), .tree = std::move(tree)};
}

/// 4 x 3 x 0.6 with three holes through it: 6 planes, 3 cylinders.
inline Part plate_with_holes() {
  return without_others({placed("plate", Box{{4, 3, 0.6}}, {0, 0, 0}), placed("a", Cylinder{0.4, 2}, {-1.2, 0.3, 0}),
                         placed("b", Cylinder{0.5, 2}, {0.4, -0.5, 0}), placed("c", Cylinder{0.3, 2}, {1.4, 0.8, 0})});
}

/// A block with a round and a conical pocket, a pocket of half a torus: 6 planes, a sphere, a cone, a torus, all
/// concave.
inline Part block_with_pockets() {
  return without_others({placed("block", Box{{6, 4, 3}}, {0, 0, 0}), placed("ball", Sphere{0.9}, {-1.8, 0, 1.5}),
                         placed("cone", Cone{.radius_bottom = 0.2, .radius_top = 0.9, .height = 1.4}, {0.3, 0, 0.8}),
                         placed("ring", Torus{.major_radius = 0.8, .minor_radius = 0.25}, {1.8, 0.3, 1.5})});
}

inline double diagonal_of(const PointCloud& cloud) {
  return bounds_of(cloud.positions).diagonal().norm();
}

inline PointCloud cloud_of(const Part& part, double noise, std::size_t count = 20'000, double normal_noise_deg = 0) {
  return sample_surface({.primitives = part.primitives, .tree = part.tree},
                        {.count = count, .noise = noise, .normal_noise_deg = normal_noise_deg, .seed = 11});
}

/// About the edge of the square that each point has, for a part with an area of some ten to a hundred.
inline double spacing_of(const PointCloud& cloud) {
  return diagonal_of(cloud) * 1.2 / std::sqrt(static_cast<double>(cloud.size()));
}

inline Detection detect(const PointCloud& cloud, double noise, const DetectOptions& options = {},
                        const RunContext& run = {}) {
  return detect_surfaces(
      cloud,
      {.box = bounds_of(cloud.positions), .diagonal = diagonal_of(cloud), .spacing = spacing_of(cloud), .noise = noise},
      options, run);
}

inline std::size_t count_of(const Detection& detection, SurfaceType type) {
  return static_cast<std::size_t>(std::count_if(detection.surfaces.begin(), detection.surfaces.end(),
                                                [&](const auto& s) { return s.surface.type == type; }));
}

/// The surfaces of one type, by ascending radius.
inline std::vector<Surface> by_radius(const Detection& detection, SurfaceType type) {
  std::vector<Surface> found;
  for (const DetectedSurface& s : detection.surfaces) {
    if (s.surface.type == type) found.push_back(s.surface);
  }
  std::sort(found.begin(), found.end(), [](const Surface& a, const Surface& b) { return a.radius < b.radius; });
  return found;
}

}  // namespace cloud2csg::test
