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

/// How time, memory and the trees of an extraction grow with the size of the task, on families of models with known
/// truth.
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
  field(&O::families, "families", "Models of these families", {.option = "family"});
  field(&O::primitives, "primitives",
        "Sizes of models; each is extracted from `points_per_primitive` points a primitive, and from `at_points`",
        k_family_sizes);
  field(&O::points_per_primitive, "points_per_primitive", "Points of these, by primitive", at_least(1));
  field(&O::at_points, "at_points", "Points of these in all, measured as well", at_least(1));
  field(&O::points, "points", "Sizes of clouds of the model with `at_primitives`", from_to(1, 1e9));
  field(&O::at_primitives, "at_primitives", "Primitives of their model", k_family_sizes);
  field(&O::cliques, "cliques", "Sizes of cliques, of family random with `at_primitives` and `at_points`",
        k_clique_sizes);
  field(&O::noise, "noise", "Standard deviation by which each coordinate is moved. Features are of about unit size.",
        at_least(0), {.unit = "SIGMA"});
  field(&O::repeats, "repeats", "Runs of each size, with a seed each", at_least(1));
  field(&O::seed, "seed", "Seed of model, cloud and search of the first repeat");
  field(&O::threads, "threads", "The largest of each family is also run on one thread", at_least(1), k_library);
  field(&O::time_limit_seconds, "time_limit_seconds",
        "Seconds for the search of a run, which is then not complete; 0: no limit", at_least(0), {.unit = "SECONDS"});
}
/// No families or sizes, or one twice.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const ScalingOptions& options);

/// A size of the task.
struct ScalingCase {
  Family family = Family::chain;
  std::size_t clique_size = 4;  ///< of family random
  std::size_t primitives = 0;
  std::size_t points = 0;
  int threads = 1;

  friend bool operator==(const ScalingCase&, const ScalingCase&) = default;
};

/// What is varied while the rest stays.
enum class Sweep {
  primitives,            ///< with points_per_primitive points each
  primitives_at_points,  ///< with at_points points in all
  points,
  cliques,
};
[[nodiscard]] std::span<const Sweep> all_sweeps();
/// As in the names of files.
constexpr auto names_of(Sweep /*any*/) {
  return std::to_array<EnumName<Sweep>>({{"primitives", Sweep::primitives},
                                         {"primitives_at_points", Sweep::primitives_at_points},
                                         {"points", Sweep::points},
                                         {"cliques", Sweep::cliques}});
}

/// The cases of a sweep for a family, smallest first; none for cliques of other families than random.
[[nodiscard]] std::vector<ScalingCase> cases_of(const ScalingOptions& options, Sweep sweep, Family family);
/// Of a case, what the sweep varies.
[[nodiscard]] double size_in(Sweep sweep, const ScalingCase& scaling_case);
/// The largest case of a family, on one thread and on all: only the second when these are the same.
[[nodiscard]] std::vector<ScalingCase> thread_cases(const ScalingOptions& options, Family family);

/// One extraction, and what was measured on it.
struct ScalingRun {
  ScalingCase scaling_case;
  std::uint64_t seed = 1;
  std::string finished = {};  ///< date and time, UTC, ISO 8601
  bool complete = true;       ///< false when the time limit ended the search
  std::size_t partitions = 0, components = 0;
  StageSeconds seconds = {};
  TreeStatistics tree = {}, true_tree = {};
  std::string fingerprint = {};  ///< of the tree: another one has another
  std::size_t generations = 0, evaluations = 0;
  /// How far the memory of the process grew over what it was before the extraction, cloud and primitives included
  /// there; 0 where the system does not tell.
  std::size_t peak_bytes = 0;
  std::size_t cloud_bytes = 0;
  double wrong_share = 0;            ///< of places near the primitives' surfaces: in one of tree and truth only
  std::size_t wrong_primitives = 0;  ///< near which a tenth of the places is wrong at least
};

struct ScalingResults {
  ScalingOptions options = {};
  Environment environment = {};
  std::vector<ScalingRun> runs = {};  ///< as they ended
};

/// A case and seed for each run, in the order in which they are made: repeats take turns, so that a machine that gets
/// slower for a while does not do so to one size.
[[nodiscard]] std::vector<std::pair<ScalingCase, std::uint64_t>> plan_runs(const ScalingOptions& options);

/// Makes one run. @throws Cancelled
[[nodiscard]] ScalingRun run_scaling_case(const ScalingCase& scaling_case, std::uint64_t seed,
                                          const ScalingOptions& options, const RunContext& run = {});

/// Makes the planned runs that are not in `folder`/scaling.json yet; it is written after each, whole or not at all.
/// Progress: a stage a family.
/// @throws Error when `folder` holds results of other options, another machine or another version; Cancelled
[[nodiscard]] ScalingResults measure_scaling(const ScalingOptions& options, const std::filesystem::path& folder,
                                             const RunContext& run = {});

[[nodiscard]] std::string to_json(const ScalingResults& results);
/// @throws Error naming the file and the field
[[nodiscard]] ScalingResults read_scaling_results(const std::filesystem::path& file);

/// value = factor * size^exponent, fitted.
struct PowerLaw {
  std::size_t count = 0;  ///< of the pairs that went into it; with fewer than two sizes there is no fit, and it is 0
  double factor = 0;
  double exponent = 0;
  double error = 0;  ///< standard error of the exponent; 0 for two pairs, which any law fits
};
/// Least squares of log(value) against log(size). Pairs whose value is not positive are left out.
[[nodiscard]] PowerLaw fit_power_law(std::span<const std::pair<double, double>> size_and_value);

/// Share of places where the two trees differ, and around how many primitives more than a tenth does. Places are drawn
/// around the primitives, equally many each: `offset` to either side of their surfaces and within their bounds. Only
/// the primitives near a place are looked at: O(n log n + overlaps).
struct Disagreement {
  double share = 0;
  std::size_t primitives = 0;
};
[[nodiscard]] Disagreement disagreement(const CsgTree& a, const CsgTree& b, const PrimitiveSet& primitives,
                                        double offset, std::uint64_t seed, const RunContext& run = {});

/// Runs of the same case and seed whose trees differ by the number of threads: there must be none.
[[nodiscard]] std::vector<std::string> thread_disagreements(const ScalingResults& results);

/// Tables and figures: *.csv, scaling.md and figures (.gp scripts and, by gnuplot, .svg) into the folder.
/// Returns notes on what could not be made: without gnuplot there are no .svg. @throws Error
[[nodiscard]] std::vector<std::string> write_scaling_report(const std::filesystem::path& folder,
                                                            const ScalingResults& results);

}  // namespace cloud2csg
