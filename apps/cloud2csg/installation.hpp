#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace cloud2csg::app {

/// The text of --version: version and optional parts. Loads nothing.
[[nodiscard]] std::string version_text();

/// The first executable of this name in a search path ("/usr/bin:/bin").
[[nodiscard]] std::optional<std::filesystem::path> find_program(const std::string& name,
                                                                const std::string& search_path);

/// The folder of the shipped models: beside an installed program, or in its build folder.
[[nodiscard]] std::optional<std::filesystem::path> shipped_models();

}  // namespace cloud2csg::app
