#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {
namespace {

constexpr std::array<PaperMode, 6> k_modes{{
    {"BST", Strategy::baseline, Parallel::none},
    {"BMTGA", Strategy::baseline, Parallel::population},
    {"SST", Strategy::partition, Parallel::none},
    {"SMTP", Strategy::partition, Parallel::partitions},
    {"SMTGA", Strategy::partition, Parallel::population},
    {"SMTPGA", Strategy::partition, Parallel::both},
}};

}  // namespace

std::span<const PaperMode> paper_modes() {
  return k_modes;
}

const PaperMode& paper_mode(std::string_view name) {
  const auto* const found =
      std::find_if(k_modes.begin(), k_modes.end(), [name](const PaperMode& mode) { return mode.name == name; });
  if (found == k_modes.end()) {
    throw invalid_option("mode", fmt::format("expected a mode of the paper, found '{}'", name));
  }
  return *found;
}

std::optional<OptionConflict> conflict_in(const PaperOptions& options) {
  if (options.models.empty()) return OptionConflict{"models", "expected one at least, found none"};
  for (auto name = options.models.begin(); name != options.models.end(); ++name) {
    if (std::find(options.models.begin(), name, *name) == name) continue;
    return OptionConflict{"models", fmt::format("'{}' is named twice", *name)};
  }
  if (options.high_points <= options.low_points) {
    return OptionConflict{"high_points", fmt::format("expected more than `low_points` ({}), found {}",
                                                     options.low_points, options.high_points)};
  }
  if (options.evaluator == PaperEvaluator::reference && options.preset != PaperPreset::paper) {
    return OptionConflict{"evaluator", "expected classes, since reference goes with `preset` paper only"};
  }
  return std::nullopt;
}

std::vector<RunName> plan_runs(const PaperOptions& options) {
  std::vector<RunName> plan;
  for (const std::string& model : options.models) {
    for (const Sampling sampling : {Sampling::low, Sampling::high}) {
      for (std::size_t repeat = 0; repeat < options.repeats; ++repeat) {
        for (const PaperMode& mode : k_modes) {
          plan.push_back(
              {.model = model, .sampling = sampling, .mode = std::string(mode.name), .seed = options.seed + repeat});
        }
      }
    }
  }
  return plan;
}

}  // namespace cloud2csg
