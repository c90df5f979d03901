#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cloud2csg::app {

/// What --version prints: version and optional parts. Loads nothing.
[[nodiscard]] std::string version_text();

/// The first program of this name in the folders of a search path ("/usr/bin:/bin") that can be run.
[[nodiscard]] std::optional<std::filesystem::path> find_program(const std::string& name,
                                                                const std::string& search_path);

/// Where the shipped models are: beside an installed program, or in the build folder that the program is in.
[[nodiscard]] std::optional<std::filesystem::path> shipped_models();

}  // namespace cloud2csg::app
