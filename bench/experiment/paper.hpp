#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/extract.hpp"
#include "cloud2csg/model.hpp"

/// The paper's evaluation (its section 5) as a repeatable experiment.
namespace cloud2csg {

/// The paper's modes. Baseline: BST (one thread), BMTGA (population in parallel). Partitioned: SST (one thread), SMTP
/// (partitions in parallel), SMTGA (population in parallel), SMTPGA (both).
struct PaperMode {
  std::string_view name;
  Strategy strategy;
  Parallel parallel;
};
[[nodiscard]] std::span<const PaperMode> paper_modes();
/// @throws Error for an unknown name.
[[nodiscard]] const PaperMode& paper_mode(std::string_view name);

enum class Sampling { low, high };
constexpr auto names_of(Sampling /*any*/) {
  return std::to_array<EnumName<Sampling>>({{"low", Sampling::low}, {"high", Sampling::high}});
}

enum class PaperPreset {
  paper,    ///< the paper's weights and search only
  standard  ///< "default"
};
constexpr auto names_of(PaperPreset /*any*/) {
  return std::to_array<EnumName<PaperPreset>>({{"paper", PaperPreset::paper}, {"default", PaperPreset::standard}});
}

enum class PaperEvaluator {
  classes,   ///< extract_csg()
  reference  ///< the paper's steps alone, each tree evaluated at each point like the paper's program
};
constexpr auto names_of(PaperEvaluator /*any*/) {
  return std::to_array<EnumName<PaperEvaluator>>(
      {{"classes", PaperEvaluator::classes}, {"reference", PaperEvaluator::reference}});
}

struct PaperOptions {
  std::vector<std::string> models = {};
  std::size_t low_points = 10'000;
  std::size_t high_points = 150'000;
  double noise = 0.01;
  std::size_t repeats = 5;
  std::uint64_t seed = 1;
  PaperPreset preset = PaperPreset::paper;
  PaperEvaluator evaluator = PaperEvaluator::classes;
  int threads = 1;

  friend bool operator==(const PaperOptions&, const PaperOptions&) = default;
};
void option_table(OptionsOf<PaperOptions>, auto&& field) {
  using O = PaperOptions;
  field(&O::models, "models", "Names of models: NAME for the file NAME.json in the folder of models", k_library);
  field(&O::low_points, "low_points", "Points per cloud, low sampling", at_least(1));
  field(&O::high_points, "high_points", "Points per cloud, high sampling", at_least(2));
  field(&O::noise, "noise", "Standard deviation of the noise added to each coordinate", at_least(0), {.unit = "SIGMA"});
  field(&O::repeats, "repeats", "Runs of each mode, each with its own seed for the search", at_least(1));
  field(&O::seed, "seed", "Seed of the clouds and of the search of the first repeat");
  field(&O::preset, "preset", "paper: the paper's weights and search, without additions");
  field(&O::evaluator, "evaluator",
        "reference: only the paper's steps, evaluating each tree at each point; thousands of times slower");
  field(&O::threads, "threads", "Threads of the parallel modes; at most one per core", at_least(1), k_library);
}
/// Refuses no models, repeated models, equal point counts for both samplings, and the reference with preset `default`.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const PaperOptions& options);

/// The machine and program of a measurement.
struct Environment {
  std::string version;
  std::string compiler;  ///< with its version
  std::string cpu;       ///< model name as the system reports it
  int cores = 0;         ///< available to the process

  friend bool operator==(const Environment&, const Environment&) = default;
};
[[nodiscard]] Environment current_environment();

struct ModelDetails {
  std::string name;
  std::size_t primitives = 0;
  TreeStatistics tree = {};
  std::string fingerprint = {};  ///< hash of the whole model
};

/// The identity of a run in an experiment.
struct RunName {
  std::string model;
  Sampling sampling = Sampling::low;
  std::string mode;
  std::uint64_t seed = 1;  ///< seed of the search

  friend bool operator==(const RunName&, const RunName&) = default;
};

struct PaperRun {
  RunName name;
  std::string finished;  ///< date and time, UTC, ISO 8601
  std::size_t points = 0;
  std::vector<std::size_t> clique_histogram = {};
  StageSeconds seconds = {};
  TreeStatistics tree = {};
  std::string formula;
  FitStatistics fit = {};
  std::size_t generations = 0, evaluations = 0;  ///< all searches, including those of the merge
  std::vector<std::string> merge_ways = {};      ///< one per connected component
  /// Pairs of trees that share primitives and did not merge. The evaluator "reference" unites them as they are.
  std::size_t blocked = 0;
};

struct PaperResults {
  PaperOptions options = {};
  Environment environment = {};
  std::vector<ModelDetails> models = {};
  std::vector<PaperRun> runs = {};  ///< in order of completion
};

/// All runs of an experiment in order. The modes alternate to share temporary slowdowns of the machine.
[[nodiscard]] std::vector<RunName> plan_runs(const PaperOptions& options);

/// Makes the planned runs that `results` lacks and adds them. All runs of a model and sampling share a cloud. Calls
/// on_finished() after each run. Each cloud starts with an unmeasured run. `models` are those of options.models, in
/// this order, each with a tree. Reports progress as one stage per cloud.
/// @throws Error, Cancelled (`results` keeps the finished runs)
void run_paper(std::span<const Model> models, PaperResults& results, const std::function<void()>& on_finished,
               const RunContext& run = {});

/// The same with models from a folder. Writes `folder`/paper.json atomically after each run and skips runs in it.
/// @throws Error for a model that is missing or has no tree, or results of other options, machine or version; Cancelled
[[nodiscard]] PaperResults reproduce_paper(const PaperOptions& options, const std::filesystem::path& models,
                                           const std::filesystem::path& folder, const RunContext& run = {});

[[nodiscard]] std::string to_json(const PaperResults& results);
/// @throws Error naming the file and the field
[[nodiscard]] PaperResults read_paper_results(const std::filesystem::path& file);

struct Spread {
  std::size_t count = 0;
  double mean = 0;
  double deviation = 0;  ///< sample standard deviation; 0 for a single value
};
[[nodiscard]] Spread spread_of(std::span<const double> values);
/// a / b for independent a and b, with the deviation to first order. Precondition: b.mean is not 0.
[[nodiscard]] Spread ratio(const Spread& a, const Spread& b);

/// Runs of equal model, sampling, strategy and seed whose trees differ between modes; expected to be empty.
[[nodiscard]] std::vector<std::string> mode_disagreements(const PaperResults& results);

/// Writes tables and figures: *.csv, paper.md, .gp scripts and, by gnuplot, .svg. Returns notes on missing files:
/// without gnuplot there are no .svg. @throws Error
[[nodiscard]] std::vector<std::string> write_paper_report(const std::filesystem::path& folder,
                                                          const PaperResults& results);

enum class Difference {
  same,     ///< within the noise, or too small to matter
  better,   ///< faster, smaller
  worse,    ///< slower, larger
  unknown,  ///< fewer than two repeats on one side
};
/// "same", "better", "worse", "unknown"
constexpr auto names_of(Difference /*any*/) {
  return std::to_array<EnumName<Difference>>({{"same", Difference::same},
                                              {"better", Difference::better},
                                              {"worse", Difference::worse},
                                              {"unknown", Difference::unknown}});
}

/// One measure of one model, sampling and mode in two results.
struct Change {
  std::string model;
  Sampling sampling = Sampling::low;
  std::string mode;
  std::string measure;  ///< "duration, ms", "nodes", "rms distance", "evaluations"; less is better
  Spread before = {}, after = {};
  double relative = 0;  ///< after / before - 1, of the means
  Difference difference = Difference::unknown;
};

struct ResultComparisonOptions {
  double least_time_change = 0.1;
  double least_change = 0.02;
  double error_rate = 0.05;
};
void option_table(OptionsOf<ResultComparisonOptions>, auto&& field) {
  using O = ResultComparisonOptions;
  field(&O::least_time_change, "least_time_change",
        "Durations that differ by less than this share count as the same. Between two experiments on one machine, "
        "means differ by more than the spread within one experiment suggests.",
        k_share, {.unit = "SHARE"});
  field(&O::least_change, "least_change",
        "Nodes, distances and evaluations that differ by less than this share count as the same", k_share,
        {.unit = "SHARE"});
  field(&O::error_rate, "error_rate",
        "Probability that any of the changes is called better or worse by accident (Bonferroni's correction)", k_share,
        {.unit = "P"});
}

/// Compares the measures of two results: durations of all modes, other measures of BST and SST. A measure is better or
/// worse when Welch's t-test finds different means and the change is large enough to matter.
/// @throws Error naming the option when models, points, noise, preset or threads differ.
[[nodiscard]] std::vector<Change> compare_paper_results(const PaperResults& before, const PaperResults& after,
                                                        const ResultComparisonOptions& options = {});

/// Two-sided p-value of Welch's t-test: the probability that means of two normal samples with equal mean and any
/// variances differ at least this much. Precondition: at least two values in each.
[[nodiscard]] double welch_test(const Spread& a, const Spread& b);

[[nodiscard]] std::string changes_markdown(std::span<const Change> changes);

}  // namespace cloud2csg
