#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/experiment/require.hpp"
#include "bench/experiment/scaling.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_sweeps{Sweep::primitives, Sweep::primitives_at_points, Sweep::points, Sweep::cliques};
constexpr std::size_t k_clique_size = FamilyOptions{}.clique_size;

/// A list of sizes of which no two are the same; it may be empty.
void require_sizes(const std::vector<std::size_t>& sizes, const char* field) {
  for (auto size = sizes.begin(); size != sizes.end(); ++size) {
    require(*size >= 1, field, "expected 1 or more, found 0");
    require(std::find(sizes.begin(), size, *size) == size, field, fmt::format("{} is named twice", *size));
  }
}

void add_if_new(std::vector<ScalingCase>& cases, const ScalingCase& one) {
  if (std::find(cases.begin(), cases.end(), one) == cases.end()) cases.push_back(one);
}

/// Of all sweeps and the threads, each once.
std::vector<ScalingCase> cases_of(const ScalingOptions& options, Family family) {
  std::vector<ScalingCase> cases;
  for (const Sweep sweep : k_sweeps) {
    for (const ScalingCase& one : cases_of(options, sweep, family)) add_if_new(cases, one);
  }
  for (const ScalingCase& one : thread_cases(options, family)) add_if_new(cases, one);
  std::stable_sort(cases.begin(), cases.end(), [](const ScalingCase& a, const ScalingCase& b) {
    return a.primitives * a.points < b.primitives * b.points;
  });
  return cases;
}

}  // namespace

void validate(const ScalingOptions& options) {
  require(!options.families.empty(), "families", "expected one at least, found none");
  for (auto family = options.families.begin(); family != options.families.end(); ++family) {
    require(std::find(options.families.begin(), family, *family) == family, "families",
            fmt::format("{} is named twice", to_string(*family)));
  }
  require_sizes(options.primitives, "primitives");
  require_sizes(options.points, "points");
  require_sizes(options.cliques, "cliques");
  require(!options.primitives.empty() || !options.points.empty(), "primitives", "expected one size at least");
  for (const std::size_t size : options.primitives) validate(FamilyOptions{.primitives = size});
  for (const std::size_t size : options.cliques) validate(FamilyOptions{.clique_size = size});
  validate(FamilyOptions{.primitives = options.at_primitives});
  require(options.points_per_primitive >= 1, "points_per_primitive", "expected 1 or more, found 0");
  require(options.at_points >= 1, "at_points", "expected 1 or more, found 0");
  require(std::isfinite(options.noise) && options.noise >= 0, "noise",
          fmt::format("expected a number of 0 or more, found {}", options.noise));
  require(options.repeats >= 1, "repeats", "expected 1 or more, found 0");
  require(options.threads >= 1, "threads", fmt::format("expected 1 or more, found {}", options.threads));
  require(std::isfinite(options.time_limit_seconds) && options.time_limit_seconds >= 0, "time_limit_seconds",
          fmt::format("expected a number of 0 or more, found {}", options.time_limit_seconds));
}

std::span<const Sweep> all_sweeps() {
  return k_sweeps;
}

std::string_view to_string(Sweep sweep) {
  switch (sweep) {
    case Sweep::primitives:
      return "primitives";
    case Sweep::primitives_at_points:
      return "primitives_at_points";
    case Sweep::points:
      return "points";
    case Sweep::cliques:
      return "cliques";
  }
  return "";
}

std::vector<ScalingCase> cases_of(const ScalingOptions& options, Sweep sweep, Family family) {
  std::vector<ScalingCase> cases;
  const auto add = [&](std::size_t clique_size, std::size_t primitives, std::size_t points) {
    cases.push_back({.family = family,
                     .clique_size = clique_size,
                     .primitives = primitives,
                     .points = points,
                     .threads = options.threads});
  };
  switch (sweep) {
    case Sweep::primitives:
      for (const std::size_t n : options.primitives) add(k_clique_size, n, n * options.points_per_primitive);
      break;
    case Sweep::primitives_at_points:
      for (const std::size_t n : options.primitives) add(k_clique_size, n, options.at_points);
      break;
    case Sweep::points:
      for (const std::size_t points : options.points) add(k_clique_size, options.at_primitives, points);
      break;
    case Sweep::cliques:
      if (family != Family::random) break;
      for (const std::size_t size : options.cliques) add(size, options.at_primitives, options.at_points);
      break;
  }
  std::sort(cases.begin(), cases.end(),
            [sweep](const ScalingCase& a, const ScalingCase& b) { return size_in(sweep, a) < size_in(sweep, b); });
  return cases;
}

double size_in(Sweep sweep, const ScalingCase& scaling_case) {
  const std::size_t size = sweep == Sweep::points    ? scaling_case.points
                           : sweep == Sweep::cliques ? scaling_case.clique_size
                                                     : scaling_case.primitives;
  return static_cast<double>(size);
}

std::vector<ScalingCase> thread_cases(const ScalingOptions& options, Family family) {
  std::vector<ScalingCase> largest = cases_of(options, Sweep::primitives, family);
  if (largest.empty()) largest = cases_of(options, Sweep::points, family);
  std::vector<ScalingCase> cases(options.threads == 1 ? 1 : 2, largest.back());
  cases.front().threads = 1;
  return cases;
}

std::vector<std::pair<ScalingCase, std::uint64_t>> plan_runs(const ScalingOptions& options) {
  std::vector<std::pair<ScalingCase, std::uint64_t>> plan;
  for (const Family family : options.families) {
    for (std::size_t repeat = 0; repeat < options.repeats; ++repeat) {
      for (const ScalingCase& one : cases_of(options, family)) plan.emplace_back(one, options.seed + repeat);
    }
  }
  return plan;
}

}  // namespace cloud2csg
