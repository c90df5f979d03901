#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench/experiment/scaling.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_sweeps{Sweep::primitives, Sweep::primitives_at_points, Sweep::points, Sweep::cliques};
constexpr std::size_t k_clique_size = FamilyOptions{}.clique_size;

/// An entry that a list contains twice.
template <typename Value>
std::optional<OptionConflict> repeated_in(const std::vector<Value>& values, const char* field) {
  for (auto value = values.begin(); value != values.end(); ++value) {
    if (std::find(values.begin(), value, *value) == value) continue;
    return OptionConflict{field, value_text(*value) + " is named twice"};
  }
  return std::nullopt;
}

void add_if_new(std::vector<ScalingCase>& cases, const ScalingCase& one) {
  if (std::find(cases.begin(), cases.end(), one) == cases.end()) cases.push_back(one);
}

/// All cases of a family, from sweeps and threads, each once.
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

std::optional<OptionConflict> conflict_in(const ScalingOptions& options) {
  if (options.families.empty()) return OptionConflict{"families", "expected one at least, found none"};
  if (options.primitives.empty() && options.points.empty()) {
    return OptionConflict{"primitives", "expected one size at least"};
  }
  if (auto conflict = repeated_in(options.families, "families")) return conflict;
  if (auto conflict = repeated_in(options.primitives, "primitives")) return conflict;
  if (auto conflict = repeated_in(options.points, "points")) return conflict;
  return repeated_in(options.cliques, "cliques");
}

std::span<const Sweep> all_sweeps() {
  return k_sweeps;
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
