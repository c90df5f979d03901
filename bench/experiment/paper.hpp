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

/// The paper's evaluation (its section 5) as an experiment that anybody can repeat.
namespace cloud2csg {

/// The paper's modes: BST, BMTGA (baseline, on one thread or with the population in parallel), SST, SMTP, SMTGA, SMTPGA
/// (partitioned: on one thread, partitions in parallel, population in parallel, both).
struct PaperMode {
  std::string_view name;
  Strategy strategy;
  Parallel parallel;
};
[[nodiscard]] std::span<const PaperMode> paper_modes();
/// @throws Error when there is none of this name.
[[nodiscard]] const PaperMode& paper_mode(std::string_view name);

enum class Sampling { low, high };
constexpr auto names_of(Sampling /*any*/) {
  return std::to_array<EnumName<Sampling>>({{"low", Sampling::low}, {"high", Sampling::high}});
}

enum class PaperPreset {
  paper,    ///< its weights and search, nothing added
  standard  ///< "default"
};
constexpr auto names_of(PaperPreset /*any*/) {
  return std::to_array<EnumName<PaperPreset>>({{"paper", PaperPreset::paper}, {"default", PaperPreset::standard}});
}

enum class PaperEvaluator {
  classes,   ///< extract_csg()
  reference  ///< the paper's steps alone, each tree evaluated at each point as its program does
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
  field(&O::models, "models", "NAME for the file NAME.json of the folder of models", k_library);
  field(&O::low_points, "low_points", "Points of a cloud, low sampling", at_least(1));
  field(&O::high_points, "high_points", "Points of a cloud, high sampling", at_least(2));
  field(&O::noise, "noise", "Standard deviation by which each coordinate is moved", at_least(0), {.unit = "SIGMA"});
  field(&O::repeats, "repeats", "Runs of each mode, with a seed each for the search", at_least(1));
  field(&O::seed, "seed", "Seed of the clouds and of the first repeat's search");
  field(&O::preset, "preset", "paper: the paper's weights and search, nothing added");
  field(&O::evaluator, "evaluator",
        "reference: the paper's steps alone, each tree at each point, thousands of times slower");
  field(&O::threads, "threads", "Threads of the parallel modes; no more than the machine has cores", at_least(1),
        k_library);
}
/// No models, or one twice; as many points for both samplings; the reference with the preset `default`.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const PaperOptions& options);

/// Where and with what numbers were measured.
struct Environment {
  std::string version;   ///< of cloud2csg
  std::string compiler;  ///< and its version
  std::string cpu;       ///< as the system names the model
  int cores = 0;         ///< that the process may use

  friend bool operator==(const Environment&, const Environment&) = default;
};
[[nodiscard]] Environment current_environment();

struct ModelDetails {
  std::string name;
  std::size_t primitives = 0;
  TreeStatistics tree = {};      ///< the true one
  std::string fingerprint = {};  ///< of the whole model: another one has another
};

/// What tells a run from all others of an experiment.
struct RunName {
  std::string model;
  Sampling sampling = Sampling::low;
  std::string mode;
  std::uint64_t seed = 1;  ///< of the search

  friend bool operator==(const RunName&, const RunName&) = default;
};

/// One extraction, and what was measured on it.
struct PaperRun {
  RunName name;
  std::string finished;  ///< date and time, UTC, ISO 8601
  std::size_t points = 0;
  std::vector<std::size_t> clique_histogram = {};
  StageSeconds seconds = {};
  TreeStatistics tree = {};
  std::string formula;  ///< the tree as text
  FitStatistics fit = {};
  std::size_t generations = 0, evaluations = 0;  ///< of all searches, those of the merge included
  std::vector<std::string> merge_ways = {};      ///< one a connected component
  /// Pairs of trees that share primitives and did not merge. With the evaluator "reference", which has no fall-backs,
  /// they are united as they are.
  std::size_t blocked = 0;
};

struct PaperResults {
  PaperOptions options = {};
  Environment environment = {};
  std::vector<ModelDetails> models = {};
  std::vector<PaperRun> runs = {};  ///< as they ended
};

/// All runs of an experiment, in the order in which they are made: the modes take turns, so that a machine that gets
/// slower for a while does not do so to one of them.
[[nodiscard]] std::vector<RunName> plan_runs(const PaperOptions& options);

/// Makes the planned runs that `results` does not have yet and adds them. The cloud of a model and sampling is the same
/// in all of them. Calls on_finished() after each; a single run that is not measured goes before those of a cloud.
/// `models`: those of options.models, in this order, each with a tree. Progress: a stage a cloud.
/// @throws Error, Cancelled (what `results` got by then stays)
void run_paper(std::span<const Model> models, PaperResults& results, const std::function<void()>& on_finished,
               const RunContext& run = {});

/// The same from files to a file: models from a folder, results in `folder`/paper.json, which is written after each
/// run, whole or not at all. Runs that are in there are not made again.
/// @throws Error when a model is missing or has no tree, `folder` holds results of other options, another machine or
/// another version; Cancelled
[[nodiscard]] PaperResults reproduce_paper(const PaperOptions& options, const std::filesystem::path& models,
                                           const std::filesystem::path& folder, const RunContext& run = {});

[[nodiscard]] std::string to_json(const PaperResults& results);
/// @throws Error naming the file and the field
[[nodiscard]] PaperResults read_paper_results(const std::filesystem::path& file);

/// A mean over repeats.
struct Spread {
  std::size_t count = 0;
  double mean = 0;
  double deviation = 0;  ///< sample standard deviation; 0 for a single value
};
[[nodiscard]] Spread spread_of(std::span<const double> values);
/// a / b, its deviation to first order, a and b being independent. Precondition: b.mean is not 0.
[[nodiscard]] Spread ratio(const Spread& a, const Spread& b);

/// Runs of one model, sampling, strategy and seed whose trees differ by the mode: there must be none.
[[nodiscard]] std::vector<std::string> mode_disagreements(const PaperResults& results);

/// Tables and figures: *.csv, paper.md and figures (.gp scripts and, by gnuplot, .svg) into the folder.
/// Returns notes on what could not be made: without gnuplot there are no .svg.
/// @throws Error
[[nodiscard]] std::vector<std::string> write_paper_report(const std::filesystem::path& folder,
                                                          const PaperResults& results);

enum class Verdict {
  same,     ///< within the noise, or too small a change to matter
  better,   ///< faster, smaller
  worse,    ///< slower, larger
  unknown,  ///< fewer than two repeats on one side
};
/// "same", "better", "worse", "unknown"
constexpr auto names_of(Verdict /*any*/) {
  return std::to_array<EnumName<Verdict>>(
      {{"same", Verdict::same}, {"better", Verdict::better}, {"worse", Verdict::worse}, {"unknown", Verdict::unknown}});
}

/// One measure of one model, sampling and mode in two results.
struct Change {
  std::string model;
  Sampling sampling = Sampling::low;
  std::string mode;
  std::string measure;  ///< "duration, ms", "nodes", "rms distance", "evaluations": of all, less is better
  Spread before = {}, after = {};
  double relative = 0;  ///< after / before - 1, of the means
  Verdict verdict = Verdict::unknown;
};

struct ResultComparisonOptions {
  double least_time_change = 0.1;
  double least_change = 0.02;
  double error_rate = 0.05;
};
void option_table(OptionsOf<ResultComparisonOptions>, auto&& field) {
  using O = ResultComparisonOptions;
  field(&O::least_time_change, "least_time_change",
        "Durations that differ by less than this share are the same. Between two experiments on a machine, means move "
        "by more than the spread within one tells.",
        k_share, {.unit = "SHARE"});
  field(&O::least_change, "least_change",
        "Nodes, distances and evaluations that differ by less than this share are the same", k_share,
        {.unit = "SHARE"});
  field(&O::error_rate, "error_rate",
        "Chance that any of all the changes is called better or worse by accident (Bonferroni's correction)", k_share,
        {.unit = "P"});
}

/// The measures of `after` against those of `before`: durations of all modes, the rest of BST and SST. One is better or
/// worse when Welch's t-test says that the means differ, and they do by enough to matter.
/// @throws Error naming the option when the two are not of the same models, points, noise, preset and threads.
[[nodiscard]] std::vector<Change> compare_paper_results(const PaperResults& before, const PaperResults& after,
                                                        const ResultComparisonOptions& options = {});

/// Chance that the means of two samples from normal distributions of the same mean, whatever their variances, differ
/// by as much as these, or more (two-sided). Precondition: two values at least in each.
[[nodiscard]] double welch_test(const Spread& a, const Spread& b);

/// As a table.
[[nodiscard]] std::string changes_markdown(std::span<const Change> changes);

}  // namespace cloud2csg
