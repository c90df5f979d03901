#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cloud2csg::app {

/// What write_point_cloud() and export_model() take.
[[nodiscard]] std::span<const std::string_view> cloud_endings();
[[nodiscard]] std::span<const std::string_view> model_endings();

/// The endings, separated by blanks: for messages and help.
[[nodiscard]] std::string join_endings(std::span<const std::string_view> endings);

/// Finds before the work starts what would stop the result from being written when it ends.
/// @throws Error for an ending that is not among `endings`, a folder that is missing or cannot be written to.
void check_output(const std::filesystem::path& file, std::span<const std::string_view> endings);

/// Refuses a list of inputs and outputs in which two name the same file.
/// @throws Error
void check_distinct(std::span<const std::string> files);

}  // namespace cloud2csg::app
