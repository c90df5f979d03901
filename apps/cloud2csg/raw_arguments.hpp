#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/input.hpp"
#include "cloud2csg/reconstruct.hpp"

namespace cloud2csg::app {

/// What is asked of the way from a raw cloud or mesh to primitives, as given on the command line.
struct RawArguments {
  std::optional<double> tolerance;
  std::optional<double> normal_tolerance_deg;
  std::optional<std::size_t> least_points;
  double leaf_cost = SolidOptions{}.leaf_cost;
  bool estimates_normals = false;
  bool keeps_outliers = false;
  bool leaves_open = false;
  bool does_not_snap = false;
  std::vector<double> radii;
  std::vector<std::string> axes;  ///< lists of directions
  std::optional<double> min_size, max_size;
  std::size_t point_budget = CleanOptions{}.point_budget;
  std::size_t mesh_points = InputOptions{}.mesh_points;

  /// The options of the library for what was read: the extraction's are those given.
  [[nodiscard]] ReconstructOptions options(const ExtractOptions& extraction, const Input& input) const;
  [[nodiscard]] InputOptions input(const ExtractOptions& extraction) const;
};

/// Adds them to a subcommand's help, in a group of this name.
void add_raw_arguments(CLI::App& app, RawArguments& arguments, const std::string& group);

/// Finds values that are each right for their option but not together.
/// @throws CLI::ValidationError naming the option
void check_arguments(const RawArguments& arguments);

}  // namespace cloud2csg::app
