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
  std::optional<std::string> strategy, parallel;
  std::optional<std::uint64_t> seed;
  std::optional<double> time_limit_seconds;
  bool no_polish = false;

  std::optional<int> population, elites, tournament, height_limit, idle_generations, generation_limit;
  std::optional<double> crossover_rate, mutation_rate, new_tree_rate;
  std::optional<std::size_t> listing_limit;

  std::optional<double> alpha, beta, gamma;
  std::optional<double> distance_tolerance, angle_tolerance_deg, overlap_tolerance;

  /// @throws Error naming the option that is out of range.
  [[nodiscard]] ExtractOptions options() const;
};

/// Adds them to a subcommand's help, in groups.
void add_extract_arguments(CLI::App& app, ExtractArguments& arguments);

}  // namespace cloud2csg::app
