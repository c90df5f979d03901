#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"

namespace cloud2csg::app {

/// @throws Error naming the file when this build has no page to make reports of.
void check_report_page(const std::string& file);

/// The options of a subcommand that have a value: given, or by default. No switches that were not given.
[[nodiscard]] std::vector<ReportParameter> parameters_of(const CLI::App& command);

/// Writes the reports among `files`. @throws Error, Cancelled
void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run);

}  // namespace cloud2csg::app
