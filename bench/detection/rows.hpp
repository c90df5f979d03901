#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "detection/scene.hpp"

namespace cloud2csg::bench {

/// What is measured, by the table's columns.
struct TestedFeature {
  std::string name;
  double size = 0;  ///< over sigma
  Question question = {};
};

/// Clouds that differ by the seed only.
struct Trial {
  std::string cloud;                    ///< what is wrong with it
  std::vector<TestedFeature> features;  ///< a row for each
  std::function<Scene(std::uint64_t)> make;
};

struct TrialGroup {
  std::string name;  ///< for the command line
  std::string title;
  std::vector<Trial> trials;
};

[[nodiscard]] std::vector<TrialGroup> all_trials();

/// The oracle's threshold for each feature.
[[nodiscard]] std::vector<double> thresholds_of(const Trial& trial);

constexpr std::size_t k_few_points = 50;  ///< rows with more points have to reach the goal

/// Points on the first tested surface, copies and outliers not counted.
[[nodiscard]] std::size_t count_points(const Scene& scene, const TestedFeature& feature);

}  // namespace cloud2csg::bench
