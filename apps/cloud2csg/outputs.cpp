#include "outputs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/error.hpp"
#include "command.hpp"
#include "core/base/files.hpp"
#include "field_arguments.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg::app {
namespace {

/// Formats that a page can offer as downloads.
bool is_text_model(const std::filesystem::path& file) {
  const FileFormat* const format = format_by_ending(file);
  return format->kind == FileKind::model || format->kind == FileKind::script || format->id == FileFormat::Id::step;
}

std::string corner(const Eigen::Vector3d& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z());
}

/// Adds what a user should know about a written solid and cannot see in the file.
void add_brep_warnings(std::vector<std::string>& warnings, const std::string& file, const BrepReport& report,
                       const PrimitiveSet& primitives, const BrepOptions& options) {
  for (const FailedNode& failed : report.failed) {
    warnings.push_back(fmt::format("{}: {} has facets, since its exact solid could not be made: {}", file, failed.node,
                                   failed.reason));
  }
  for (const PrimitiveIndex index : report.faceted) {
    warnings.push_back(
        fmt::format("{}: '{}' has no exact surface: it was written with facets", file, primitives[index].id));
  }
  if (!report.is_valid) warnings.push_back(fmt::format("{}: OpenCASCADE finds faults in the solid", file));
  if (report.volume_difference() > options.volume_tolerance) {
    warnings.push_back(
        fmt::format("{}: the volume of the solid, {:.6g}, differs from that of the tree, {:.6g}, by {:.2g} %", file,
                    report.volume, report.tree_volume, 100 * report.volume_difference()));
  }
}

/// Names the part after the user's file instead of the temporary one.
ExportOptions named_for(const std::string& file, ExportOptions options) {
  if (options.brep.name.empty()) options.brep.name = std::filesystem::path(file).stem().string();
  return options;
}

std::string value_of(const CLI::Option& option) {
  if (option.count() == 0) return option.get_default_str();
  if (option.get_expected_max() == 0) return "yes";
  return fmt::format("{}", fmt::join(option.results(), ", "));
}

}  // namespace

std::string cloud_endings() {
  return endings_written({FileKind::cloud});
}
std::string model_endings() {
  using Kind = FileKind;
  return endings_written({Kind::model, Kind::script, Kind::solid, Kind::mesh, Kind::graph, Kind::page, Kind::picture});
}

void check_output(const std::filesystem::path& file, const std::string& endings, bool is_statistics) {
  const auto refuse = [&file](std::string expected, std::string remedy) {
    throw Error({.file = file.string(), .expected = std::move(expected), .remedy = std::move(remedy)});
  };
  const FileFormat* const format = format_by_ending(file);
  if (format == nullptr || (endings + ' ').find(fmt::format("{} ", format->endings[0])) == std::string::npos) {
    const std::string ending = file.extension().string();
    throw WrongUsage({.file = file.string(),
                      .expected = ending.empty()      ? std::string("the file name has no ending")
                                  : format == nullptr ? fmt::format("unknown ending '{}'", ending)
                                                      : fmt::format("{} ('{}') cannot be written by this command",
                                                                    kind_name(format->kind), ending),
                      .remedy = fmt::format("use one of {}", endings)});
  }
  if (format->kind == FileKind::solid) require_brep(file);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    refuse(fmt::format("cannot be written: there is no folder '{}'", folder.string()), "create the folder first");
  }
  if (std::filesystem::is_directory(file, ignored))
    refuse("cannot be written: it is a folder", "give the name of a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(fmt::format("cannot be written: folder '{}' ({})", folder.string(), std::strerror(errno)),
           "check its permissions");
  }
  if (is_report(file)) check_report_page(file.string());
  check_overwriting(file, is_statistics);
}

bool is_picture(const std::filesystem::path& file) {
  return has_ending_of(file, FileKind::picture);
}

bool is_report(const std::filesystem::path& file) {
  return has_ending_of(file, FileKind::page);
}

void add_pictures(OutputSet& set, std::span<const std::string> files, const Scene& scene, const PictureOptions& options,
                  const RunContext& run) {
  for (const std::string& file : files) {
    if (!is_picture(file)) continue;
    set.add(file, [&](const std::filesystem::path& path) { write_picture(path, scene, options, run); });
  }
}

bool needs_tree(const std::filesystem::path& file) {
  const FileFormat* const format = format_by_ending(file);
  return format == nullptr || format->id != FileFormat::Id::json;
}

AddedModels add_models(OutputSet& set, std::span<const std::string> files, const Model& model,
                       const ExportOptions& options, const RunContext& run) {
  AddedModels added;
  for (const std::string& file : files) {
    if (is_report(file) || is_picture(file)) continue;
    ExportReport report;
    set.add(file, [&](const std::filesystem::path& path) {
      report = export_model(path, model, named_for(file, options), run);
      if (!is_text_model(file) || !std::filesystem::is_regular_file(path)) return;
      added.texts.push_back({std::filesystem::path(file).filename().string(), read_text_file(path)});
    });
    if (report.brep) add_brep_warnings(added.warnings, file, *report.brep, model.primitives, options.brep);
    if (!report.cut_at) continue;
    added.warnings.push_back(fmt::format("{}: the solid is unbounded and was cut at {} to {}; intersect it with a box",
                                         file, corner(report.cut_at->min()), corner(report.cut_at->max())));
  }
  return added;
}

void check_distinct(std::span<const std::string> files) {
  std::vector<std::filesystem::path> seen;
  for (const std::string& file : files) {
    std::error_code ignored;
    std::filesystem::path path = std::filesystem::weakly_canonical(file, ignored);
    if (std::find(seen.begin(), seen.end(), path) != seen.end()) {
      throw WrongUsage({.file = file,
                        .expected = "is named twice, so one file would overwrite the other",
                        .remedy = "give each file its own name"});
    }
    seen.push_back(std::move(path));
  }
}

void check_outputs(std::span<const std::string> outputs, const std::string& endings,
                   std::span<const std::string> inputs) {
  for (const std::string& file : outputs) check_output(file, endings);
  std::vector<std::string> files(outputs.begin(), outputs.end());
  files.insert(files.end(), inputs.begin(), inputs.end());
  check_distinct(files);
}

void write_clouds(std::span<const std::string> files, const PointCloud& cloud, const CloudWriteOptions& options) {
  OutputSet written;
  for (const std::string& file : files) {
    written.add(file, [&](const std::filesystem::path& path) { write_point_cloud(path, cloud, options); });
  }
  written.commit();
}

void check_report_page(const std::string& file) {
  if (has_report_page()) return;
  throw Error({.file = file,
               .expected = "cannot be shown: this cloud2csg was built without the report page",
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
