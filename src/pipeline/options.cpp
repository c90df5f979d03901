#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"

namespace cloud2csg {
namespace {

void require(bool holds, const char* field, const std::string& expected) {
  if (!holds) throw Error({.file = {}, .where = field, .expected = expected, .remedy = {}});
}

void require_positive(double value, const char* field) {
  require(std::isfinite(value) && value > 0, field, fmt::format("expected a number > 0, found {}", value));
}

void require_share(double value, const char* field) {
  require(value >= 0 && value <= 1, field, fmt::format("expected a number from 0 to 1, found {}", value));
}

void require_at_least(int value, int least, const char* field) {
  require(value >= least, field, fmt::format("expected {} or more, found {}", least, value));
}

void validate(const GaOptions& search) {
  require_at_least(search.population, 2, "population");
  require_at_least(search.elites, 0, "elites");
  require(search.elites < search.population, "elites",
          fmt::format("expected fewer than the population ({}), found {}", search.population, search.elites));
  require_at_least(search.tournament, 1, "tournament");
  require_share(search.crossover_rate, "crossover_rate");
  require_share(search.mutation_rate, "mutation_rate");
  require_share(search.new_tree_rate, "new_tree_rate");
  require_at_least(search.height_limit.value_or(1), 1, "height_limit");
  require_at_least(search.idle_generations, 1, "idle_generations");
  require_at_least(search.generation_limit, 1, "generation_limit");
  require(search.listing_limit <= 5, "listing_limit",
          fmt::format("expected 5 or less, found {}", search.listing_limit));
  require_share(search.trust, "trust");
  require_at_least(search.restarts, 0, "restarts");
}

}  // namespace

std::string_view to_string(Strategy strategy) {
  switch (strategy) {
    case Strategy::automatic:
      return "auto";
    case Strategy::cells:
      return "cells";
    case Strategy::partition:
      return "partition";
    case Strategy::baseline:
      return "baseline";
  }
  return "";
}

std::string_view to_string(Parallel parallel) {
  switch (parallel) {
    case Parallel::none:
      return "none";
    case Parallel::population:
      return "population";
    case Parallel::partitions:
      return "partitions";
    case Parallel::both:
      return "both";
  }
  return "";
}

std::string_view to_string(MergeWay way) {
  switch (way) {
    case MergeWay::single:
      return "single";
    case MergeWay::paper:
      return "paper";
    case MergeWay::dominance:
      return "dominance";
    case MergeWay::largest_common_subtree:
      return "largest_common_subtree";
    case MergeWay::joint:
      return "joint";
    case MergeWay::search:
      return "search";
  }
  return "";
}

ExtractOptions paper_options() {
  ExtractOptions options;
  options.strategy = Strategy::partition;
  options.objective.beta = 100.0;
  options.precision = Precision::full;
  options.search = paper_ga_options();
  options.without_strangers = false;
  options.polish = false;
  return options;
}

void validate(const ExtractOptions& options) {
  if (options.segmentation.distance_tolerance) {
    require_positive(*options.segmentation.distance_tolerance, "distance_tolerance");
  }
  const double angle = options.segmentation.angle_tolerance_deg;
  require(angle > 0 && angle <= 90, "angle_tolerance_deg",
          fmt::format("expected a number above 0 and at most 90, found {}", angle));
  if (options.objective.alpha) {
    require(std::isfinite(*options.objective.alpha) && *options.objective.alpha >= 0, "alpha",
            fmt::format("expected a number >= 0, found {}", *options.objective.alpha));
  }
  if (options.objective.beta) require_positive(*options.objective.beta, "beta");
  require_positive(options.objective.gamma, "gamma");
  if (options.overlap_tolerance) {
    require(std::isfinite(*options.overlap_tolerance) && *options.overlap_tolerance >= 0, "overlap_tolerance",
            fmt::format("expected a number >= 0, found {}", *options.overlap_tolerance));
  }
  require(std::isfinite(options.cell_trust) && options.cell_trust >= 0, "cell_trust",
          fmt::format("expected a number >= 0, found {}", options.cell_trust));
  require(options.cell_samples.base >= 1, "cell_samples.base", "expected 1 or more, found 0");
  require(options.cell_labels.absence >= 0, "cell_labels.absence", "expected a number >= 0");
  require(options.cell_labels.absence_in_scans >= 0, "cell_labels.absence_in_scans", "expected a number >= 0");
  require(options.cell_labels.presence >= 0, "cell_labels.presence", "expected a number >= 0");
  require(options.cell_labels.sight >= 0, "cell_labels.sight", "expected a number >= 0");
  require(!options.cell_solve.least_evidence.empty(), "cell_solve.least_evidence", "expected at least one number");
  require(std::ranges::none_of(options.cell_solve.least_evidence, [](double least) { return !(least >= 0); }),
          "cell_solve.least_evidence", "expected numbers >= 0");
  require(std::ranges::is_sorted(options.cell_solve.least_evidence, std::greater<>()), "cell_solve.least_evidence",
          "expected descending numbers");
  require(options.cell_solve.leaf_cost >= 0, "cell_solve.leaf_cost", "expected a number >= 0");
  if (options.time_limit_seconds) require_positive(*options.time_limit_seconds, "time_limit");
  validate(options.search);
}

}  // namespace cloud2csg
