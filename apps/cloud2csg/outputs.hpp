#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/export.hpp"
#include "cloud2csg/picture.hpp"
#include "cloud2csg/report.hpp"
#include "core/base/file_ending.hpp"
#include "core/base/output_set.hpp"
#include "core/base/overwriting.hpp"

namespace cloud2csg::app {

/// What write_point_cloud() takes; what export_model() and write_report() take.
[[nodiscard]] std::span<const std::string_view> cloud_endings();
[[nodiscard]] std::span<const std::string_view> model_endings();

/// The endings, separated by blanks: for messages and help.
[[nodiscard]] std::string join_endings(std::span<const std::string_view> endings);

/// Finds before the work starts what would stop the result from being written when it ends.
/// @throws WrongUsage for an ending that is not among `endings`, Error for a folder that is missing or cannot be
/// written to, a file of another kind that is there.
void check_output(const std::filesystem::path& file, std::span<const std::string_view> endings,
                  Content content = Content::by_ending);

/// Whether a model must have a tree to be written to a file of this ending.
[[nodiscard]] bool needs_tree(const std::filesystem::path& file);

struct AddedModels {
  std::vector<std::string> warnings;  ///< what the formats cannot hold
  std::vector<ReportDownload> texts;  ///< what was written as text, for a report
};

/// Writes a model to those files of a set that are no reports. @throws Error, Cancelled
[[nodiscard]] AddedModels add_models(OutputSet& set, std::span<const std::string> files, const Model& model,
                                     const ExportOptions& options, const RunContext& run);

/// Whether a file is to be a picture, by its ending.
[[nodiscard]] bool is_picture(const std::filesystem::path& file);

/// Draws the pictures among `files`. @throws Error, Cancelled
void add_pictures(OutputSet& set, std::span<const std::string> files, const Scene& scene, const PictureOptions& options,
                  const RunContext& run);

/// Size and view of pictures, as a group of a subcommand's help.
void add_picture_options(CLI::App& app, PictureOptions& options);

/// @throws WrongUsage naming the option
void check_pictures(const PictureOptions& options);

/// How meshes of solids are made, in the group of outputs.
void add_mesh_options(CLI::App& app, ExportOptions& options);

/// Refuses a list of inputs and outputs in which two name the same file.
/// @throws WrongUsage
void check_distinct(std::span<const std::string> files);

}  // namespace cloud2csg::app
