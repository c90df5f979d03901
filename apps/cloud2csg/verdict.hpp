#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cloud2csg/extract.hpp"
#include "session.hpp"

/// How `extract` and `detect` end.
namespace cloud2csg::app {

/// `--json`
void add_json_option(CLI::App& options, bool& json);

/// Prints the largest unexplained regions and the verdict to standard error and, with `json`, one line of JSON to
/// standard output. Returns the exit status. `files`: those written; of a failed result there are none.
[[nodiscard]] int tell_verdict(Session& session, const ExtractStatistics& statistics,
                               std::span<const std::string> files, bool json);

/// Prints the line of JSON of a run that ended with this error. Throws nothing: it is told while an error is handled.
void tell_failure(std::string_view message);

}  // namespace cloud2csg::app
