#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cloud2csg::app {

/// One part of the installation, as `doctor` tells of it.
struct Finding {
  enum class State {
    fine,
    absent,  ///< left out, and most works without
    broken,  ///< should be there
  };
  State state = State::fine;
  std::string part;
  std::string text;
  std::string remedy = {};
};

/// Looks at all parts; takes as long as OpenCASCADE takes to load.
[[nodiscard]] std::vector<Finding> examine_installation();

/// What --version prints: version and optional parts. Loads nothing.
[[nodiscard]] std::string version_text();

/// The first program of this name in the folders of a search path ("/usr/bin:/bin") that can be run.
[[nodiscard]] std::optional<std::filesystem::path> find_program(const std::string& name,
                                                                const std::string& search_path);

/// Where the shipped models are: beside an installed program, or in the build folder that the program is in.
[[nodiscard]] std::optional<std::filesystem::path> shipped_models();

}  // namespace cloud2csg::app
