#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cloud2csg/export.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"

namespace cloud2csg::app {

/// Endings for write_point_cloud(); endings for export_model(), write_report() and write_picture().
[[nodiscard]] std::string cloud_endings();
[[nodiscard]] std::string model_endings();

/// Checks before the work whether the result can be written. @throws WrongUsage for an ending that is not in `endings`
/// (separated by blanks); Error for a missing or read-only folder, or an existing file of another format.
void check_output(const std::filesystem::path& file, const std::string& endings, bool is_statistics = false);

/// Whether a file of this ending needs a model with a tree.
[[nodiscard]] bool needs_tree(const std::filesystem::path& file);

struct AddedModels {
  std::vector<std::string> warnings;  ///< what the formats cannot hold
  std::vector<ReportDownload> texts;  ///< text files, for a report
};

/// Writes a model to the `files` that are neither reports nor pictures. @throws Error, Cancelled
[[nodiscard]] AddedModels add_models(OutputSet& set, std::span<const std::string> files, const Model& model,
                                     const ExportOptions& options, const RunContext& run);

[[nodiscard]] bool is_picture(const std::filesystem::path& file);
[[nodiscard]] bool is_report(const std::filesystem::path& file);

/// Draws the pictures among `files`. @throws Error, Cancelled
void add_pictures(OutputSet& set, std::span<const std::string> files, const Scene& scene, const PictureOptions& options,
                  const RunContext& run);

/// Refuses a list in which two names are the same file. @throws WrongUsage
void check_distinct(std::span<const std::string> files);

/// check_output() and check_distinct() for all outputs of a command and its `inputs`.
void check_outputs(std::span<const std::string> outputs, const std::string& endings,
                   std::span<const std::string> inputs = {});

/// Writes a cloud to all files, or to none. @throws Error
void write_clouds(std::span<const std::string> files, const PointCloud& cloud, const CloudWriteOptions& options);

/// @throws Error naming the file when this build has no report page.
void check_report_page(const std::string& file);

/// All options of a subcommand with a given or default value; no switches that were not given.
[[nodiscard]] std::vector<ReportParameter> parameters_of(const CLI::App& command);

/// Writes the reports among `files`. @throws Error, Cancelled
void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run);

}  // namespace cloud2csg::app
