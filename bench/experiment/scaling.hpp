#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bench/experiment/paper.hpp"
#include "bench/families/family.hpp"
#include "cloud2csg/extract.hpp"

/// Growth of time, memory and trees with the size of the task, on families of models with known truth.
namespace cloud2csg {

struct ScalingOptions {
  std::vector<Family> families = {Family::chain, Family::grid, Family::plate, Family::random, Family::nest};
  std::vector<std::size_t> primitives = {10, 30, 100, 300, 1000};
  std::size_t points_per_primitive = 500;
  std::size_t at_points = 100'000;
  std::vector<std::size_t> points = {10'000, 30'000, 100'000, 300'000, 1'000'000};
  std::size_t at_primitives = 100;
  std::vector<std::size_t> cliques = {2, 4, 6, 8, 10, 12};
  double noise = 0.005;
  std::size_t repeats = 3;
  std::uint64_t seed = 1;
  int threads = 1;
  double time_limit_seconds = 0;

  friend bool operator==(const ScalingOptions&, const ScalingOptions&) = default;
};
void option_table(OptionsOf<ScalingOptions>, auto&& field) {
  using O = ScalingOptions;
  field(&O::families, "families", "Families of models", {.option = "family"});
  field(&O::primitives, "primitives",
        "Numbers of primitives; each model is extracted from `points_per_primitive` points per primitive, and from "
        "`at_points` in all",
        k_family_sizes);
  field(&O::points_per_primitive, "points_per_primitive", "Points per primitive, for the models of `primitives`",
        at_least(1));
  field(&O::at_points, "at_points", "Points in all, for additional runs of the models of `primitives`", at_least(1));
  field(&O::points, "points", "Sizes of clouds, of the model with `at_primitives` primitives", from_to(1, 1e9));
  field(&O::at_primitives, "at_primitives", "Primitives of the model for `points` and `cliques`", k_family_sizes);
  field(&O::cliques, "cliques",
        "Sizes of cliques, in family random with `at_primitives` primitives and `at_points` points", k_clique_sizes);
  field(&O::noise, "noise", "Standard deviation of the noise added to each coordinate. Features have about unit size.",
        at_least(0), {.unit = "SIGMA"});
  field(&O::repeats, "repeats", "Runs of each size, each with its own seed", at_least(1));
  field(&O::seed, "seed", "Seed of model, cloud and search of the first repeat");
  field(&O::threads, "threads", "Threads of most runs; the largest case of each family also runs on one thread",
        at_least(1), k_library);
  field(&O::time_limit_seconds, "time_limit_seconds",
        "Time limit of a run's search in seconds, after which the run is not complete; 0: no limit", at_least(0),
        {.unit = "SECONDS"});
}
/// Refuses empty or repeated families and sizes.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const ScalingOptions& options);

struct ScalingCase {
  Family family = Family::chain;
  std::size_t clique_size = 4;  ///< family random only
  std::size_t primitives = 0;
  std::size_t points = 0;
  int threads = 1;

  friend bool operator==(const ScalingCase&, const ScalingCase&) = default;
};

/// The quantity that varies while others stay.
enum class Sweep {
  primitives,            ///< with points_per_primitive points per primitive
  primitives_at_points,  ///< with at_points points in all
  points,
  cliques,
};
[[nodiscard]] std::span<const Sweep> all_sweeps();
/// As in file names.
constexpr auto names_of(Sweep /*any*/) {
  return std::to_array<EnumName<Sweep>>({{"primitives", Sweep::primitives},
                                         {"primitives_at_points", Sweep::primitives_at_points},
                                         {"points", Sweep::points},
                                         {"cliques", Sweep::cliques}});
}

/// The cases of a sweep for a family, smallest first. Only family random has cases for cliques.
[[nodiscard]] std::vector<ScalingCase> cases_of(const ScalingOptions& options, Sweep sweep, Family family);
/// The value of a case that the sweep varies.
[[nodiscard]] double size_in(Sweep sweep, const ScalingCase& scaling_case);
/// The largest case of a family on one thread and on all threads; a single case if these are the same.
[[nodiscard]] std::vector<ScalingCase> thread_cases(const ScalingOptions& options, Family family);

struct ScalingRun {
  ScalingCase scaling_case;
  std::uint64_t seed = 1;
  std::string finished = {};  ///< date and time, UTC, ISO 8601
  bool complete = true;       ///< false when the time limit ended the search
  std::size_t partitions = 0, components = 0;
  StageSeconds seconds = {};
  TreeStatistics tree = {}, true_tree = {};
  std::string fingerprint = {};  ///< hash of the tree
  std::size_t generations = 0, evaluations = 0;
  /// Memory growth during the extraction, beyond cloud and primitives; 0 where the system does not report it.
  std::size_t peak_bytes = 0;
  std::size_t cloud_bytes = 0;
  double wrong_share = 0;            ///< share of places near the primitives' surfaces where tree and truth differ
  std::size_t wrong_primitives = 0;  ///< primitives with at least a tenth of the places around them wrong
};

struct ScalingResults {
  ScalingOptions options = {};
  Environment environment = {};
  std::vector<ScalingRun> runs = {};  ///< in order of completion
};

/// Case and seed of each run in order. Repeats alternate to share temporary slowdowns of the machine.
[[nodiscard]] std::vector<std::pair<ScalingCase, std::uint64_t>> plan_runs(const ScalingOptions& options);

[[nodiscard]] ScalingRun run_scaling_case(const ScalingCase& scaling_case, std::uint64_t seed,
                                          const ScalingOptions& options, const RunContext& run = {});

/// Adds missing planned runs to `folder`/scaling.json, written atomically after each. Progress: one stage per family.
/// @throws Error when `folder` holds results of other options, another machine or another version; Cancelled
[[nodiscard]] ScalingResults measure_scaling(const ScalingOptions& options, const std::filesystem::path& folder,
                                             const RunContext& run = {});

[[nodiscard]] std::string to_json(const ScalingResults& results);
/// @throws Error naming the file and the field
[[nodiscard]] ScalingResults read_scaling_results(const std::filesystem::path& file);

/// A fit of value = factor * size^exponent.
struct PowerLaw {
  std::size_t count = 0;  ///< fitted pairs; 0, without a fit, for fewer than two sizes
  double factor = 0;
  double exponent = 0;
  double error = 0;  ///< standard error of the exponent; 0 for two pairs, which fit exactly
};
/// Least squares of log(value) against log(size). Leaves out pairs with a value that is not positive.
[[nodiscard]] PowerLaw fit_power_law(std::span<const std::pair<double, double>> size_and_value);

/// Share of places where two trees differ, and number of primitives with more than a tenth of such places around them.
/// Each primitive gets equally many places, within its bounds and at `offset` on either side of its surface. Looks only
/// at primitives near a place: O(n log n + overlaps).
struct Disagreement {
  double share = 0;
  std::size_t primitives = 0;
};
[[nodiscard]] Disagreement disagreement(const CsgTree& a, const CsgTree& b, const PrimitiveSet& primitives,
                                        double offset, std::uint64_t seed, const RunContext& run = {});

/// Runs of equal case and seed whose trees differ with the number of threads; expected to be empty.
[[nodiscard]] std::vector<std::string> thread_disagreements(const ScalingResults& results);

/// Writes tables and figures: *.csv, scaling.md, .gp scripts and, by gnuplot, .svg. Returns notes on missing files:
/// without gnuplot there are no .svg. @throws Error
[[nodiscard]] std::vector<std::string> write_scaling_report(const std::filesystem::path& folder,
                                                            const ScalingResults& results);

}  // namespace cloud2csg
