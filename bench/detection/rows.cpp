#include "detection/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "detection/bar.hpp"
#include "detection/household.hpp"
#include "detection/oracle.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::array<std::size_t, 5> k_points{30, 60, 150, 500, 2000};

std::string name_of(Feature feature) {
  switch (feature) {
    case Feature::step:
      return "step";
    case Feature::thin_wall:
      return "thin wall";
    case Feature::bore:
      return "bore";
    case Feature::ball:
      return "ball";
  }
  return {};
}

Trial bar_trial(const std::string& cloud, const BarOptions& options) {
  return {.cloud = cloud,
          .features = {{name_of(options.feature), options.size, question_of(options.feature)}},
          .make = [options](std::uint64_t seed) { return make_bar(options, seed); }};
}

std::vector<Trial> plain_trials(Feature feature, std::initializer_list<double> sizes) {
  std::vector<Trial> trials;
  for (const double size : sizes) {
    for (const std::size_t points : k_points) {
      trials.push_back(bar_trial("plain", {.feature = feature, .size = size, .points = points}));
    }
  }
  return trials;
}

/// The size and the number of points of a ball determine the noise.
std::vector<Trial> ball_trials() {
  constexpr double k_most_noise = 0.0055;  // 0.5 % of the bar's diagonal, for which estimate_scale() is made
  std::vector<Trial> trials;
  for (const double size : {5.0, 10.0, 15.0, 30.0}) {
    for (const std::size_t points : {60U, 150U, 500U}) {
      Conditions conditions;
      conditions.noise = noise_of_ball(size, points, conditions.density);
      if (conditions.noise > k_most_noise) continue;
      trials.push_back(
          bar_trial("plain", {.feature = Feature::ball, .size = size, .points = points, .conditions = conditions}));
    }
  }
  return trials;
}

/// Steps of 5 sigma and bores of 10, under conditions that are worse than plain ones.
std::vector<Trial> trials_under(const std::string& cloud, const Conditions& conditions,
                                std::initializer_list<std::size_t> points_of_steps,
                                std::initializer_list<std::size_t> points_of_bores) {
  std::vector<Trial> trials;
  for (const std::size_t points : points_of_steps) {
    trials.push_back(
        bar_trial(cloud, {.feature = Feature::step, .size = 5, .points = points, .conditions = conditions}));
  }
  for (const std::size_t points : points_of_bores) {
    trials.push_back(
        bar_trial(cloud, {.feature = Feature::bore, .size = 10, .points = points, .conditions = conditions}));
  }
  return trials;
}

void append(std::vector<Trial>& trials, const std::vector<Trial>& more) {
  trials.insert(trials.end(), more.begin(), more.end());
}

std::vector<Trial> noise_trials() {
  constexpr double k_ratio = 4;
  constexpr double k_quiet = 0.0016;  // bores of 10 sigma and 500 points then end within the half
  std::vector<Trial> trials = trials_under("other half 4 times as noisy", {.noise = k_quiet, .far_noise = k_ratio},
                                           {60, 150, 500}, {60, 150, 500});
  append(trials, trials_under("this half 4 times as noisy", {.noise = k_ratio * k_quiet, .far_noise = 1 / k_ratio},
                              {60, 150, 500}, {60, 150, 500}));
  return trials;
}

std::vector<Trial> view_trials() {
  std::vector<Trial> trials;
  for (const double distance : {1.0, 2.0, 3.0}) {
    append(trials, trials_under(fmt::format("views {} sigma apart", distance), {.misalignment = distance},
                                {60, 150, 500}, {60, 150, 500}));
  }
  append(trials, trials_under("each view twice", {.is_seen_twice = true}, {60, 150, 500}, {60, 150, 500}));
  return trials;
}

/// The sparse half has a thirtieth of the dense half's points per area.
std::vector<Trial> density_trials() {
  constexpr double k_ratio = 30;
  // So that steps of 500 points, and bores of 150, end within a sparse half.
  constexpr double k_sparse = 3500;
  constexpr double k_dense = 30'000;
  std::vector<Trial> trials = trials_under("other half 30 times as dense",
                                           {.density = k_sparse, .far_density = k_ratio}, {60, 150, 500}, {60, 150});
  append(trials, trials_under("this half 30 times as dense", {.density = k_dense, .far_density = 1 / k_ratio},
                              {60, 150, 500}, {60, 150, 500}));
  return trials;
}

std::vector<Trial> household_trials() {
  std::vector<Trial> trials;
  for (const HouseholdThing& thing : household_things()) {
    Trial trial{
        .cloud = thing.name, .features = {}, .make = [thing](std::uint64_t seed) { return scan_thing(thing, seed); }};
    for (const HouseholdQuestion& asked : thing.questions) {
      trial.features.push_back({asked.name, asked.size, asked.question});
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

}  // namespace

std::vector<double> thresholds_of(const Trial& trial) {
  const Scene scene = trial.make(1);
  std::vector<double> thresholds;
  for (const TestedFeature& feature : trial.features) thresholds.push_back(oracle_threshold(scene, feature.question));
  return thresholds;
}

std::size_t count_points(const Scene& scene, const TestedFeature& feature) {
  const auto last = scene.surface.begin() + static_cast<std::ptrdiff_t>(scene.aligned.size());
  return static_cast<std::size_t>(std::count(scene.surface.begin(), last, feature.question.surfaces.front()));
}

std::vector<TrialGroup> all_trials() {
  const Conditions with_clusters{.clustered_outliers = 0.05};
  return {{"steps", "Steps", plain_trials(Feature::step, {0, 0.5, 1, 2, 3, 5, 10})},
          {"walls", "Thin walls", plain_trials(Feature::thin_wall, {2, 3, 5, 10})},
          {"bores", "Bores", plain_trials(Feature::bore, {2, 3, 5, 10})},
          {"balls", "Balls", ball_trials()},
          {"noise", "Local noise", noise_trials()},
          {"views", "Misaligned and duplicated views", view_trials()},
          {"outliers", "Clustered outliers",
           trials_under("a twentieth in clusters", with_clusters, {60, 150, 500, 2000}, {60, 150, 500, 2000})},
          {"densities", "Densities 1:30", density_trials()},
          {"household", "Household boxes and cans, meshed and smoothed", household_trials()}};
}

}  // namespace cloud2csg::bench
