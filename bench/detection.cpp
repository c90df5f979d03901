// Prints how many of the surfaces that could be detected are found, beside an oracle: the most powerful test with 1 %
// false positives. A table for each kind of defect; the least share of the oracle's detections that is reached; and the
// leaves of trees reconstructed from household boxes and cans.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "bench/experiment/table.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "core/base/parallel.hpp"
#include "detection/household.hpp"
#include "detection/match.hpp"
#include "detection/oracle.hpp"
#include "detection/rows.hpp"
#include "run_main.hpp"

namespace cloud2csg::bench {
namespace {

constexpr double k_goal = 0.85;  // share of the oracle's detections

struct Arguments {
  std::string part = "all";
  std::size_t seeds = 20;
  int threads = 0;
  bool with_normals = false;
};

/// Clouds in which the oracle, the project and both detect a feature.
struct Counts {
  std::size_t oracle = 0, found = 0, both = 0;
};

struct Row {
  std::string cloud;
  TestedFeature feature;
  std::size_t points = 0;  ///< on the first tested surface, of the first cloud
  Counts counts = {};
  double unmatched = 0;  ///< found surfaces that match no true one, mean

  /// Absent where there is nothing to detect.
  [[nodiscard]] std::optional<double> reached() const {
    if (feature.size == 0 || counts.oracle == 0) return std::nullopt;
    return static_cast<double>(counts.both) / static_cast<double>(counts.oracle);
  }
};

/// What one cloud says about the features of its trial.
struct Answer {
  std::vector<bool> is_detected, is_found;
  std::size_t unmatched = 0;
};

Answer ask(const Trial& trial, const std::vector<double>& thresholds, bool with_normals, std::uint64_t seed) {
  const Scene scene = trial.make(seed);
  const std::vector<DetectedSurface> found = find_surfaces(with_normals ? with_true_normals(scene) : scene.cloud);
  Answer answer{.is_detected = {}, .is_found = {}, .unmatched = count_unmatched(scene, found)};
  for (std::size_t f = 0; f < trial.features.size(); ++f) {
    const Question& question = trial.features[f].question;
    answer.is_detected.push_back(oracle_statistic(scene, question) > thresholds[f]);
    answer.is_found.push_back(is_answered(scene, question, found));
  }
  return answer;
}

/// One row for each feature, from the answers of all seeds.
std::vector<Row> rows_of(const Trial& trial, const std::vector<Answer>& answers) {
  const Scene scene = trial.make(1);
  std::vector<Row> rows;
  for (std::size_t f = 0; f < trial.features.size(); ++f) {
    const TestedFeature& feature = trial.features[f];
    Row row{.cloud = trial.cloud, .feature = feature};
    row.points = count_points(scene, feature);
    for (const Answer& answer : answers) {
      row.counts.oracle += answer.is_detected[f] ? 1U : 0U;
      row.counts.found += answer.is_found[f] ? 1U : 0U;
      row.counts.both += answer.is_detected[f] && answer.is_found[f] ? 1U : 0U;
      row.unmatched += static_cast<double>(answer.unmatched) / static_cast<double>(answers.size());
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Row> measure(const TrialGroup& group, const Arguments& arguments) {
  const RunContext run{.threads = arguments.threads};
  const std::size_t trials = group.trials.size();
  std::vector<std::vector<double>> thresholds(trials);
  for_each_index(trials, run, [&](std::size_t t) { thresholds[t] = thresholds_of(group.trials[t]); });
  std::vector<std::vector<Answer>> answers(trials, std::vector<Answer>(arguments.seeds));
  for_each_index(trials * arguments.seeds, run, [&](std::size_t i) {
    const std::size_t t = i / arguments.seeds;
    const std::size_t k = i % arguments.seeds;
    answers[t][k] = ask(group.trials[t], thresholds[t], arguments.with_normals, k + 1);
  });
  std::vector<Row> rows;
  for (std::size_t t = 0; t < trials; ++t) {
    for (Row& row : rows_of(group.trials[t], answers[t])) rows.push_back(std::move(row));
  }
  return rows;
}

std::string percent(std::size_t part, std::size_t all) {
  return fmt::format("{:.0f} %", 100 * static_cast<double>(part) / static_cast<double>(all));
}

void print_rows(const TrialGroup& group, const std::vector<Row>& rows, std::size_t seeds) {
  Table table{.name = group.name,
              .title = group.title,
              .note = fmt::format("{} clouds a row.", seeds),
              .columns = {"cloud", "tested", "size / sigma", "points", "oracle", "found", "reached", "unmatched"}};
  for (const Row& row : rows) {
    table.rows.push_back(
        {row.cloud, row.feature.name, fmt::format("{:.4g}", row.feature.size), std::to_string(row.points),
         percent(row.counts.oracle, seeds), percent(row.counts.found, seeds),
         row.reached() ? percent(row.counts.both, row.counts.oracle) : "-", fmt::format("{:.2f}", row.unmatched)});
  }
  fmt::print("{}\n", to_markdown(table));
}

void print_least(const std::vector<Row>& rows) {
  std::size_t count = 0;
  std::size_t below = 0;
  const Row* least = nullptr;
  for (const Row& row : rows) {
    if (row.points <= k_few_points || !row.reached()) continue;
    ++count;
    if (*row.reached() < k_goal) ++below;
    if (least == nullptr || *row.reached() < *least->reached()) least = &row;
  }
  if (least == nullptr) return;
  fmt::print(
      "Least share reached with more than {} points: {:.0f} % ({}, {}, {:.4g} sigma, {} points). "
      "Below {:.0f} %: {} of {} rows.\n",
      k_few_points, 100 * *least->reached(), least->cloud, least->feature.name, least->feature.size, least->points,
      100 * k_goal, below, count);
}

/// Leaves of the reconstructed tree; absent where there is none.
std::optional<std::size_t> leaves_of(const PointCloud& cloud) {
  try {
    return leaf_count(reconstruct(cloud).tree());
  } catch (const Error&) {
    return std::nullopt;
  }
}

void print_leaves(const Arguments& arguments) {
  Table table{.name = "leaves",
              .title = "Leaves of reconstructed boxes and cans",
              .note = fmt::format("{} clouds a row. Few: at most twice as many as in the true tree.", arguments.seeds),
              .columns = {"cloud", "true", "least", "median", "most", "few", "failed"}};
  for (const HouseholdThing& thing : household_things()) {
    std::vector<std::optional<std::size_t>> found(arguments.seeds);
    for_each_index(arguments.seeds, {.threads = arguments.threads},
                   [&](std::size_t k) { found[k] = leaves_of(scan_thing(thing, k + 1).cloud); });
    const std::size_t truth = leaf_count(*thing.model.tree);
    std::vector<std::size_t> leaves;
    for (const auto& count : found) {
      if (count) leaves.push_back(*count);
    }
    std::ranges::sort(leaves);
    const auto few = std::ranges::count_if(leaves, [&](std::size_t count) { return count <= 2 * truth; });
    const auto text = [&](std::size_t rank) { return leaves.empty() ? "-" : std::to_string(leaves[rank]); };
    table.rows.push_back({thing.name, std::to_string(truth), text(0), text(leaves.size() / 2),
                          leaves.empty() ? "-" : std::to_string(leaves.back()), std::to_string(few),
                          std::to_string(found.size() - leaves.size())});
  }
  fmt::print("{}\n", to_markdown(table));
}

int run(int argc, char** argv) {
  CLI::App app("Prints how many of the surfaces that could be detected are found.");
  Arguments arguments;
  const std::vector<TrialGroup> groups = all_trials();
  std::vector<std::string> parts{"all", "leaves"};
  for (const TrialGroup& group : groups) parts.push_back(group.name);
  app.add_option("--part", arguments.part, "What to measure")->check(CLI::IsMember(parts))->capture_default_str();
  app.add_option("--seeds", arguments.seeds, "Clouds a row")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--threads", arguments.threads, "Clouds at a time, 0: one a core; the result does not depend on it")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_flag("--normals", arguments.with_normals,
               "Give the true normals, to tell what detection loses from what estimated normals lose; the oracle sees "
               "positions only");
  CLI11_PARSE(app, argc, argv);
  std::vector<Row> all_rows;
  for (const TrialGroup& group : groups) {
    if (arguments.part != "all" && arguments.part != group.name) continue;
    const std::vector<Row> rows = measure(group, arguments);
    print_rows(group, rows, arguments.seeds);
    all_rows.insert(all_rows.end(), rows.begin(), rows.end());
  }
  if (arguments.part == "all" || arguments.part == "leaves" || arguments.part == "household") print_leaves(arguments);
  print_least(all_rows);
  return 0;
}

}  // namespace
}  // namespace cloud2csg::bench

int main(int argc, char** argv) {
  return cloud2csg::bench::run_main(argc, argv, cloud2csg::bench::run);
}
