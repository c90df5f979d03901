#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/output_set.hpp"
#include "cloud2csg/export.hpp"

namespace cloud2csg::app {

/// What write_point_cloud() and export_model() take.
[[nodiscard]] std::span<const std::string_view> cloud_endings();
[[nodiscard]] std::span<const std::string_view> model_endings();

/// The endings, separated by blanks: for messages and help.
[[nodiscard]] std::string join_endings(std::span<const std::string_view> endings);

/// Finds before the work starts what would stop the result from being written when it ends.
/// @throws Error for an ending that is not among `endings`, a folder that is missing or cannot be written to.
void check_output(const std::filesystem::path& file, std::span<const std::string_view> endings);

/// Whether a model must have a tree to be written to a file of this ending.
[[nodiscard]] bool needs_tree(const std::filesystem::path& file);

/// Writes a model to several files of a set. Returns warnings: what their formats cannot hold.
/// @throws Error, Cancelled
[[nodiscard]] std::vector<std::string> add_models(OutputSet& set, std::span<const std::string> files,
                                                  const Model& model, const ExportOptions& options,
                                                  const RunContext& run);

/// Refuses a list of inputs and outputs in which two name the same file.
/// @throws Error
void check_distinct(std::span<const std::string> files);

}  // namespace cloud2csg::app
