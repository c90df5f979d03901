#include "outputs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg::app {
namespace {

constexpr std::array<std::string_view, 6> k_cloud_endings{".ply", ".pcd", ".xyz", ".xyzn", ".txt", ".pts"};
constexpr std::array<std::string_view, 6> k_model_endings{".json", ".scad", ".dot", ".stl", ".off", ".obj"};

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string corner(const Eigen::Vector3d& point) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", point.x(), point.y(), point.z());
}

}  // namespace

std::span<const std::string_view> cloud_endings() {
  return k_cloud_endings;
}
std::span<const std::string_view> model_endings() {
  return k_model_endings;
}

std::string join_endings(std::span<const std::string_view> endings) {
  return fmt::format("{}", fmt::join(endings.begin(), endings.end(), " "));
}

void check_output(const std::filesystem::path& file, std::span<const std::string_view> endings) {
  const auto refuse = [&file](std::string expected, std::string remedy) {
    throw Error({.file = file.string(), .where = {}, .expected = std::move(expected), .remedy = std::move(remedy)});
  };
  const std::string ending = lower_case(file.extension().string());
  if (std::find(endings.begin(), endings.end(), ending) == endings.end()) {
    refuse(ending.empty() ? std::string("the name has no ending") : fmt::format("unknown ending '{}'", ending),
           fmt::format("use one of {}", join_endings(endings)));
  }
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    refuse(fmt::format("cannot be written: there is no folder '{}'", folder.string()), "make the folder first");
  }
  if (std::filesystem::is_directory(file, ignored)) refuse("cannot be written: it is a folder", "name a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(fmt::format("cannot be written: folder '{}' ({})", folder.string(), std::strerror(errno)),
           "check its permissions");
  }
}

bool needs_tree(const std::filesystem::path& file) {
  return lower_case(file.extension().string()) != ".json";
}

std::vector<std::string> add_models(OutputSet& set, std::span<const std::string> files, const Model& model,
                                    const ExportOptions& options, const RunContext& run) {
  std::vector<std::string> warnings;
  for (const std::string& file : files) {
    ExportReport report;
    set.add(file, [&](const std::filesystem::path& path) { report = export_model(path, model, options, run); });
    if (!report.cut_at) continue;
    warnings.push_back(fmt::format("{}: the solid has no bounds: it was cut at {} to {}; intersect it with a box", file,
                                   corner(report.cut_at->min()), corner(report.cut_at->max())));
  }
  return warnings;
}

void check_distinct(std::span<const std::string> files) {
  std::vector<std::filesystem::path> seen;
  for (const std::string& file : files) {
    std::error_code ignored;
    std::filesystem::path path = std::filesystem::weakly_canonical(file, ignored);
    if (std::find(seen.begin(), seen.end(), path) != seen.end()) {
      throw Error({.file = file,
                   .where = {},
                   .expected = "is named twice: one would overwrite the other",
                   .remedy = "give each file a name of its own"});
    }
    seen.push_back(std::move(path));
  }
}

}  // namespace cloud2csg::app
