#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/experiment/peak_memory.hpp"
#include "bench/experiment/report_files.hpp"
#include "bench/experiment/resume_check.hpp"
#include "bench/experiment/scaling.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

std::size_t bytes_of(const PointCloud& cloud) {
  return 6 * sizeof(double) * cloud.size();
}

void take_statistics(ScalingRun& result, const ExtractStatistics& statistics) {
  result.complete = statistics.complete;
  result.partitions = statistics.partitions.size();
  result.components = statistics.components;
  result.seconds = statistics.seconds;
  result.tree = statistics.tree;
  result.generations = statistics.merge.generations;
  result.evaluations = statistics.merge.evaluations;
  for (const PartitionStatistics& partition : statistics.partitions) {
    result.generations += partition.generations;
    result.evaluations += partition.evaluations;
  }
}

/// An unmeasured run that starts threads and loads code.
void warm_up(const ScalingOptions& options, const RunContext& run) {
  const ScalingCase small{.family = Family::grid, .primitives = 20, .points = 4000, .threads = options.threads};
  (void)run_scaling_case(small, options.seed, options, run);
}

void check_same_experiment(const std::filesystem::path& file, const ScalingResults& there, const ScalingResults& now) {
  const ResumeCheck check(file);
  check.same_options(there.options, now.options);
  check.same_environment(there.environment, now.environment);
}

bool has_run(const ScalingResults& results, const ScalingCase& one, std::uint64_t seed) {
  return std::any_of(results.runs.begin(), results.runs.end(),
                     [&](const ScalingRun& run) { return run.scaling_case == one && run.seed == seed; });
}

}  // namespace

ScalingRun run_scaling_case(const ScalingCase& scaling_case, std::uint64_t seed, const ScalingOptions& options,
                            const RunContext& run) {
  const RunContext inner{.stop = run.stop, .on_progress = {}, .threads = scaling_case.threads};
  const Model model =
      make_family(scaling_case.family,
                  {.primitives = scaling_case.primitives, .clique_size = scaling_case.clique_size, .seed = seed});
  const PointCloud cloud =
      sample_surface(model, {.count = scaling_case.points, .noise = options.noise, .seed = seed}, inner);
  ExtractOptions extract{.seed = seed};
  if (options.time_limit_seconds > 0) extract.time_limit_seconds = options.time_limit_seconds;
  const PeakMemory memory;
  const Extraction extraction = extract_csg(cloud, model.primitives, extract, inner);
  ScalingRun result{.scaling_case = scaling_case, .seed = seed};
  result.peak_bytes = memory.grown_bytes().value_or(0);
  result.cloud_bytes = bytes_of(cloud);
  // Only a time limit, not an interrupt, gives a valid best tree so far.
  run.throw_if_stopped();
  take_statistics(result, extraction.statistics);
  result.true_tree = statistics_of(*model.tree, model.primitives);
  result.fingerprint = fmt::format("{:016x}", structural_hash(extraction.tree()));
  // Beyond the noise, so that the side of a place is clear.
  constexpr double k_offset_in_noise = 4;
  constexpr double k_least_offset = 1e-3;  // solids are about one unit wide
  const Disagreement wrong = disagreement(extraction.tree(), *model.tree, model.primitives,
                                          std::max(k_offset_in_noise * options.noise, k_least_offset), seed, inner);
  result.wrong_share = wrong.share;
  result.wrong_primitives = wrong.primitives;
  result.finished = now_utc();
  return result;
}

ScalingResults measure_scaling(const ScalingOptions& options, const std::filesystem::path& folder,
                               const RunContext& run) {
  validate(options);
  ScalingResults results{.options = options, .environment = current_environment()};
  const std::filesystem::path file = folder / "scaling.json";
  if (std::filesystem::exists(file)) {
    ScalingResults there = read_scaling_results(file);
    check_same_experiment(file, there, results);
    results.runs = std::move(there.runs);
  }
  // Written before the first run, so that a read-only folder fails at once.
  write_text_file(file, to_json(results));
  const auto plan = plan_runs(options);
  bool is_warm = false;
  std::size_t first_of_family = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    run.throw_if_stopped();
    const ScalingCase& one = plan[i].first;
    const std::uint64_t seed = plan[i].second;
    if (one.family != plan[first_of_family].first.family) first_of_family = i;
    const auto of_family = static_cast<std::size_t>(
        std::count_if(plan.begin(), plan.end(), [&](const auto& other) { return other.first.family == one.family; }));
    if (has_run(results, one, seed)) continue;
    run.report(to_string(one.family), i - first_of_family, of_family, "runs");
    if (!is_warm) warm_up(options, run);
    is_warm = true;
    results.runs.push_back(run_scaling_case(one, seed, options, run));
    write_text_file(file, to_json(results));
    run.report(to_string(one.family), i + 1 - first_of_family, of_family, "runs");
  }
  return results;
}

std::vector<std::string> thread_disagreements(const ScalingResults& results) {
  std::vector<std::string> disagreements;
  for (auto run = results.runs.begin(); run != results.runs.end(); ++run) {
    const auto first = std::find_if(results.runs.begin(), run, [&](const ScalingRun& other) {
      ScalingCase same = other.scaling_case;
      same.threads = run->scaling_case.threads;
      return same == run->scaling_case && other.seed == run->seed && other.complete && run->complete;
    });
    if (first == run || first->fingerprint == run->fingerprint) continue;
    const ScalingCase& one = run->scaling_case;
    disagreements.push_back(fmt::format("{}, {} primitives, {} points, seed {}: {} and {} threads",
                                        to_string(one.family), one.primitives, one.points, run->seed,
                                        first->scaling_case.threads, one.threads));
  }
  return disagreements;
}

}  // namespace cloud2csg
