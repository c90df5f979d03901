#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "cloud2csg/extract.hpp"

namespace cloud2csg::app {

/// The options of the extraction as given on the command line; what was not given is as the preset has it.
struct ExtractArguments {
  std::string preset = "default";
  std::optional<std::string> strategy, parallel, precision;
  std::optional<std::uint64_t> seed;
  std::optional<double> time_limit_seconds;
  std::optional<bool> polish;
  std::optional<bool> strangers;

  std::optional<int> population, elites, tournament, height_limit, idle_generations, generation_limit, restarts;
  std::optional<double> crossover_rate, mutation_rate, new_tree_rate, trust;
  std::optional<std::size_t> listing_limit, restart_budget;
  std::optional<bool> seeds, local_search;

  std::optional<double> alpha, beta, gamma;
  std::optional<double> distance_tolerance, angle_tolerance_deg, overlap_tolerance;

  /// @throws Error naming the field that is out of range.
  [[nodiscard]] ExtractOptions options() const;
};

/// Finds values that are each right for their option but not for the extraction.
/// @throws CLI::ValidationError naming the option
void check_arguments(const CLI::App& app, const ExtractArguments& arguments);

/// Adds them to a subcommand's help, in groups.
void add_extract_arguments(CLI::App& app, ExtractArguments& arguments);

}  // namespace cloud2csg::app
