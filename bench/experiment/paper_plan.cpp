#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/require.hpp"

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
  require(found != k_modes.end(), "mode", fmt::format("expected a mode of the paper, found '{}'", name));
  return *found;
}

std::string_view to_string(Sampling sampling) {
  return sampling == Sampling::low ? "low" : "high";
}

void validate(const PaperOptions& options) {
  require(!options.models.empty(), "models", "expected one at least, found none");
  for (auto name = options.models.begin(); name != options.models.end(); ++name) {
    require(std::find(options.models.begin(), name, *name) == name, "models",
            fmt::format("'{}' is named twice", *name));
  }
  require(options.low_points >= 1, "low_points", "expected 1 or more, found 0");
  require(options.high_points > options.low_points, "high_points",
          fmt::format("expected more than low_points ({}), found {}", options.low_points, options.high_points));
  require(std::isfinite(options.noise) && options.noise >= 0, "noise",
          fmt::format("expected a number of 0 or more, found {}", options.noise));
  require(options.repeats >= 1, "repeats", "expected 1 or more, found 0");
  require(options.preset == "paper" || options.preset == "default", "preset",
          fmt::format("expected paper or default, found '{}'", options.preset));
  require(options.evaluator == "classes" || options.evaluator == "reference", "evaluator",
          fmt::format("expected classes or reference, found '{}'", options.evaluator));
  require(options.evaluator == "classes" || options.preset == "paper", "evaluator",
          "expected classes, since reference goes with the preset paper only");
  require(options.threads >= 1, "threads", fmt::format("expected 1 or more, found {}", options.threads));
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
