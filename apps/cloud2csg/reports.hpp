#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "cloud2csg/extract.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/output_set.hpp"

namespace cloud2csg::app {

/// @throws Error naming the file when this build has no page to make reports of.
void check_report_page(const std::string& file);

/// The options of a subcommand that have a value: given, or by default. No switches that were not given.
[[nodiscard]] std::vector<ReportParameter> parameters_of(const CLI::App& command);

/// Writes the reports among `files`. @throws Error, Cancelled
void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run);

/// What an extraction found, in a few lines: points, primitives, partitions, tree, fit, time by stage, files.
[[nodiscard]] std::vector<std::string> summary_of(const ExtractStatistics& statistics,
                                                  std::span<const std::string> files);

}  // namespace cloud2csg::app
