#include "reports.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "cloud2csg/error.hpp"
#include "outputs.hpp"

namespace cloud2csg::app {
namespace {

/// Empty when it has none.
std::string value_of(const CLI::Option& option) {
  if (option.count() == 0) return option.get_default_str();
  if (option.get_expected_max() == 0) return "yes";
  return fmt::format("{}", fmt::join(option.results(), ", "));
}

}  // namespace

void check_report_page(const std::string& file) {
  if (has_report_page()) return;
  throw Error({.file = file,
               .expected = "cannot be shown: this cloud2csg was built without the page of reports",
               .remedy = "install Node.js 18 or later with npm, and build again with -DCLOUD2CSG_VIEWER=ON"});
}

std::vector<ReportParameter> parameters_of(const CLI::App& command) {
  std::vector<ReportParameter> parameters;
  for (const CLI::Option* option : command.get_options()) {
    if (option == command.get_help_ptr()) continue;
    const std::string value = value_of(*option);
    if (!value.empty()) parameters.push_back({option->get_group(), option->get_name(), value});
  }
  return parameters;
}

void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run) {
  for (const std::string& file : files) {
    if (!is_report(file)) continue;
    set.add(file, [&](const std::filesystem::path& path) { write_report(path, report, {}, run); });
  }
}

}  // namespace cloud2csg::app
