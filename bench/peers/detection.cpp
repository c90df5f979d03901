// Prints recall against the processor's seconds of our detection and of CGAL's Efficient RANSAC, on the clouds of
// bench_detection. Both get the same prepared points and normals, and one thread.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "bench/experiment/table.hpp"
#include "detection/match.hpp"
#include "detection/oracle.hpp"
#include "detection/rows.hpp"
#include "peers/efficient_ransac.hpp"
#include "run_main.hpp"

namespace cloud2csg::bench {
namespace {

struct Candidate {
  std::string name, tolerance, least_points;
  Detector detect;
  std::size_t found = 0, unmatched = 0;
  double seconds = 0;
};

std::vector<Candidate> all_candidates() {
  std::vector<Candidate> candidates{
      {"cloud2csg", "-", "-", [](const PreparedCloud& prepared) {
         return detect_surfaces(prepared.cloud, prepared.scale, {}, {.threads = 1}).surfaces;
       }}};
  for (const double tolerance : {1.0, 2.0, 3.0, 5.0}) {
    for (const std::size_t least_points : {15U, 50U, 150U}) {
      candidates.push_back({"Efficient RANSAC", fmt::format("{}", tolerance), std::to_string(least_points),
                            [=](const PreparedCloud& prepared) {
                              return detect_by_ransac(prepared, {.tolerance = tolerance, .least_points = least_points});
                            }});
    }
  }
  return candidates;
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Features with more than a few points that the oracle detects.
std::vector<const TestedFeature*> shown_features(const Trial& trial, const std::vector<double>& thresholds,
                                                 const Scene& scene) {
  std::vector<const TestedFeature*> shown;
  for (std::size_t f = 0; f < trial.features.size(); ++f) {
    const TestedFeature& feature = trial.features[f];
    if (feature.size == 0 || count_points(scene, feature) <= k_few_points) continue;
    if (oracle_statistic(scene, feature.question) > thresholds[f]) shown.push_back(&feature);
  }
  return shown;
}

/// Runs all candidates on one cloud. @returns the features that could be found
std::size_t measure(const Trial& trial, const std::vector<double>& thresholds, std::uint64_t seed,
                    std::vector<Candidate>& candidates) {
  const Scene scene = trial.make(seed);
  const std::vector<const TestedFeature*> shown = shown_features(trial, thresholds, scene);
  for (Candidate& candidate : candidates) {
    const Detector timed = [&](const PreparedCloud& prepared) {
      const double start = processor_seconds();
      std::vector<DetectedSurface> surfaces = candidate.detect(prepared);
      candidate.seconds += processor_seconds() - start;
      return surfaces;
    };
    const std::vector<DetectedSurface> found = find_surfaces(scene.cloud, timed);
    candidate.found += static_cast<std::size_t>(std::ranges::count_if(
        shown, [&](const TestedFeature* feature) { return is_answered(scene, feature->question, found); }));
    candidate.unmatched += count_unmatched(scene, found);
  }
  return shown.size();
}

void print(const TrialGroup& group, std::size_t seeds) {
  std::vector<Candidate> candidates = all_candidates();
  std::size_t shown = 0;
  for (const Trial& trial : group.trials) {
    const std::vector<double> thresholds = thresholds_of(trial);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) shown += measure(trial, thresholds, seed, candidates);
  }
  const auto clouds = static_cast<double>(group.trials.size() * seeds);
  Table table{.name = group.name,
              .title = group.title,
              .note = fmt::format("{} clouds.", clouds),
              .columns = {"detector", "epsilon / sigma", "least points", "reached", "unmatched", "s a cloud"}};
  for (const Candidate& candidate : candidates) {
    table.rows.push_back(
        {candidate.name, candidate.tolerance, candidate.least_points,
         shown == 0 ? "-"
                    : fmt::format("{:.0f} %", 100 * static_cast<double>(candidate.found) / static_cast<double>(shown)),
         fmt::format("{:.2f}", static_cast<double>(candidate.unmatched) / clouds),
         fmt::format("{:.3f}", candidate.seconds / clouds)});
  }
  fmt::print("{}\n", to_markdown(table));
}

int run(int argc, char** argv) {
  CLI::App app("Prints recall against seconds of cloud2csg's detection and of CGAL's Efficient RANSAC.");
  std::size_t seeds = 2;
  std::string part = "all";
  const std::vector<TrialGroup> groups = all_trials();
  std::vector<std::string> parts{"all"};
  for (const TrialGroup& group : groups) parts.push_back(group.name);
  app.add_option("--part", part, "What to measure")->check(CLI::IsMember(parts))->capture_default_str();
  app.add_option("--seeds", seeds, "Clouds of each kind")->check(CLI::PositiveNumber)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  for (const TrialGroup& group : groups) {
    if (part == "all" || part == group.name) print(group, seeds);
  }
  return 0;
}

}  // namespace
}  // namespace cloud2csg::bench

int main(int argc, char** argv) {
  return cloud2csg::bench::run_main(argc, argv, cloud2csg::bench::run);
}
