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

/// What write_point_cloud() takes; what export_model(), write_report() and write_picture() take.
[[nodiscard]] std::string cloud_endings();
[[nodiscard]] std::string model_endings();

/// Finds before the work starts what would stop the result from being written when it ends.
/// @throws WrongUsage for an ending that is not among `endings`, which blanks separate; Error for a folder that is
/// missing or cannot be written to, a file of another format that is there.
void check_output(const std::filesystem::path& file, const std::string& endings, bool is_statistics = false);

/// Whether a model must have a tree to be written to a file of this ending.
[[nodiscard]] bool needs_tree(const std::filesystem::path& file);

struct AddedModels {
  std::vector<std::string> warnings;  ///< what the formats cannot hold
  std::vector<ReportDownload> texts;  ///< what was written as text, for a report
};

/// Writes a model to those files of a set that are no reports. @throws Error, Cancelled
[[nodiscard]] AddedModels add_models(OutputSet& set, std::span<const std::string> files, const Model& model,
                                     const ExportOptions& options, const RunContext& run);

/// Whether a file is to be a picture, or a page, by its ending.
[[nodiscard]] bool is_picture(const std::filesystem::path& file);
[[nodiscard]] bool is_report(const std::filesystem::path& file);

/// Draws the pictures among `files`. @throws Error, Cancelled
void add_pictures(OutputSet& set, std::span<const std::string> files, const Scene& scene, const PictureOptions& options,
                  const RunContext& run);

/// Refuses a list of inputs and outputs in which two name the same file. @throws WrongUsage
void check_distinct(std::span<const std::string> files);

/// Both for all outputs of a command, which are also not to be its `inputs`.
void check_outputs(std::span<const std::string> outputs, const std::string& endings,
                   std::span<const std::string> inputs = {});

/// Writes a cloud to each of the files, or to none. @throws Error
void write_clouds(std::span<const std::string> files, const PointCloud& cloud, const CloudWriteOptions& options);

/// @throws Error naming the file when this build has no page to make reports of.
void check_report_page(const std::string& file);

/// The options of a subcommand that have a value: given, or by default. No switches that were not given.
[[nodiscard]] std::vector<ReportParameter> parameters_of(const CLI::App& command);

/// Writes the reports among `files`. @throws Error, Cancelled
void add_reports(OutputSet& set, std::span<const std::string> files, const Report& report, const RunContext& run);

}  // namespace cloud2csg::app
