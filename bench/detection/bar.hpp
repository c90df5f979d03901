#pragma once

#include "detection/scene.hpp"

namespace cloud2csg::bench {

/// A detail of a bar of length 1.
enum class Feature {
  step,       ///< a rectangular part of the top is higher
  thin_wall,  ///< a square wall stands on the top
  bore,       ///< a blind hole in the end
  ball        ///< a ball sits on the top, a fifth of it sunk in
};

/// How a bar is measured. Features are in its near half, with lengths below half of the bar's.
struct Conditions {
  double noise = 0.002;           ///< standard deviation of each coordinate; 0.18 % of the bar's diagonal
  double density = 10'000;        ///< points per unit of area: 14 000 points in all, spaced 5 sigma
  double far_noise = 1;           ///< in the far half, over that in the near half
  double far_density = 1;         ///< likewise
  double misalignment = 0;        ///< distance between two views with half of the points each, in sigma
  bool is_seen_twice = false;     ///< each point once more, off by a hundredth of sigma: the same view added again
  double clustered_outliers = 0;  ///< share of the points
};

struct BarOptions {
  Feature feature = Feature::step;
  double size = 5;           ///< height of a step, thickness of a wall, radius of a bore or ball, in sigma
  std::size_t points = 500;  ///< on the tested surface; on each side of a thin wall
  Conditions conditions = {};
};

/// The noise at which a ball with so many points has a radius of `size` sigma.
[[nodiscard]] double noise_of_ball(double size, std::size_t points, double density);

/// The question of the feature: for a step, its top and the bar's top must be found; for a wall, both sides.
[[nodiscard]] Question question_of(Feature feature);

/// A measured bar in a random direction. Clouds of one seed and different options have much in common.
[[nodiscard]] Scene make_bar(const BarOptions& options, std::uint64_t seed);

}  // namespace cloud2csg::bench
