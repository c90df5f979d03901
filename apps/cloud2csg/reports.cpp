#include "reports.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cloud2csg/error.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

std::string yes_or_no(bool value) {
  return value ? "yes" : "no";
}

std::string number_or(const std::optional<double>& value, const char* otherwise) {
  return value ? fmt::format("{:.6g}", *value) : otherwise;
}

/// Empty when it has none.
std::string value_of(const CLI::Option& option) {
  if (option.count() == 0) return option.get_default_str();
  if (option.get_expected_max() == 0) return "yes";
  return fmt::format("{}", fmt::join(option.results(), ", "));
}

std::vector<ReportParameter> search_parameters(const GaOptions& search) {
  const std::string group = "Genetic algorithm";
  return {{group, "population", std::to_string(search.population)},
          {group, "elites", std::to_string(search.elites)},
          {group, "tournament", std::to_string(search.tournament)},
          {group, "crossover rate", fmt::format("{:.6g}", search.crossover_rate)},
          {group, "mutation rate", fmt::format("{:.6g}", search.mutation_rate)},
          {group, "new tree rate", fmt::format("{:.6g}", search.new_tree_rate)},
          {group, "idle generations", std::to_string(search.idle_generations)},
          {group, "generation limit", std::to_string(search.generation_limit)},
          {group, "listing limit", std::to_string(search.listing_limit)},
          {group, "trust", fmt::format("{:.6g}", search.trust)},
          {group, "restarts", std::to_string(search.restarts)},
          {group, "seeds", yes_or_no(search.seeds)},
          {group, "local search", yes_or_no(search.polish)}};
}

}  // namespace

void check_report_page(const std::string& file) {
  if (has_report_page()) return;
  throw Error({.file = file,
               .where = {},
               .expected = "cannot be shown: this cloud2csg was built without the page of reports",
               .remedy = "install Node.js 18 or later with npm, and build again with -DCLOUD2CSG_VIEWER=ON"});
}

std::vector<ReportParameter> parameters_of(const CLI::App& command) {
  std::vector<ReportParameter> parameters;
  for (const CLI::Option* option : command.get_options()) {
    if (option == command.get_help_ptr()) continue;
    const std::string value = value_of(*option);
    if (!value.empty()) parameters.push_back({"Command line", option->get_name(), value});
  }
  return parameters;
}

std::vector<ReportParameter> parameters_of(const ExtractOptions& options) {
  const std::string group = "Extraction";
  std::vector<ReportParameter> parameters{
      {group, "strategy", std::string(to_string(options.strategy))},
      {group, "seed", std::to_string(options.seed)},
      {group, "cell trust", fmt::format("{:.6g}", options.cell_trust)},
      {group, "polish", yes_or_no(options.polish)},
      {group, "judged without strangers", yes_or_no(options.without_strangers)},
      {group, "time limit", number_or(options.time_limit_seconds, "none")},
      {group, "distance tolerance", number_or(options.segmentation.distance_tolerance, "3 × measured noise")},
      {group, "angle tolerance", fmt::format("{:.6g}°", options.segmentation.angle_tolerance_deg)},
      {group, "overlap tolerance", number_or(options.overlap_tolerance, "measured noise")},
      {group, "alpha", number_or(options.objective.alpha, "ln of the points")},
      {group, "beta", number_or(options.objective.beta, "1 / measured noise")},
      {group, "gamma", fmt::format("{:.6g}", options.objective.gamma)}};
  const std::vector<ReportParameter> search = search_parameters(options.search);
  parameters.insert(parameters.end(), search.begin(), search.end());
  return parameters;
}

void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run) {
  for (const std::string& file : files) {
    if (!is_report(file)) continue;
    set.add(file, [&](const std::filesystem::path& path) { write_report(path, report, {}, run); });
  }
}

}  // namespace cloud2csg::app
