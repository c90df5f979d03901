#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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
/// "low", "high"
[[nodiscard]] std::string_view to_string(Sampling sampling);

struct PaperOptions {
  std::vector<std::string> models = {};  ///< NAME for the file NAME.json of the folder of models
  std::size_t low_points = 10'000;       ///< of a cloud of low sampling
  std::size_t high_points = 150'000;     ///< ... and of high sampling
  double noise = 0.01;                   ///< standard deviation of each coordinate (paper)
  std::size_t repeats = 5;               ///< runs a mode, each with a seed of its own for the search
  std::uint64_t seed = 1;                ///< of the clouds, and of the search of the first repeat
  std::string preset = "paper";          ///< "paper": its weights and search, nothing added; or "default"
  /// "classes": extract_csg(); or "reference": the paper's steps alone, each tree evaluated at each point as its
  /// program does, which is thousands of times slower. The latter needs preset "paper".
  std::string evaluator = "classes";
  int threads = 1;  ///< of the modes that are parallel; no more than the machine has cores

  friend bool operator==(const PaperOptions&, const PaperOptions&) = default;
};
/// @throws Error naming the field
void validate(const PaperOptions& options);

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
[[nodiscard]] std::string_view to_string(Verdict verdict);

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
  /// A duration that differs by less than this share is the same: between two experiments on a machine, means move by
  /// more than the spread within one tells.
  double least_time_change = 0.1;
  double least_change = 0.02;  ///< the same for what does not depend on the machine: nodes, distance, evaluations
  /// Chance that any of all the changes is called better or worse by accident (Bonferroni's correction).
  double error_rate = 0.05;
};

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
