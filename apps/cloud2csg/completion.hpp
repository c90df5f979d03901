#pragma once

#include <string>

#include "catalogue.hpp"

/// Scripts that complete the program's commands, options, values and files, for each shell. Made of the catalogue at
/// the time of the build, so that a shell need not run the program.
namespace cloud2csg::app {

[[nodiscard]] std::string bash_completion(const CommandEntry& program);
[[nodiscard]] std::string zsh_completion(const CommandEntry& program);
[[nodiscard]] std::string fish_completion(const CommandEntry& program);

/// As one word of a shell: in single quotes, which are themselves put as `quote`.
[[nodiscard]] std::string quoted(const std::string& text, const std::string& quote);

/// Endings of all files that a command takes by place, none twice.
[[nodiscard]] std::vector<std::string> argument_endings(const CommandEntry& command);

}  // namespace cloud2csg::app
