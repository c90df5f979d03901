#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

namespace cloud2csg::app {

/// What the last of these words of a command line, which may be empty, can become: a line each, with a tab and what it
/// means behind it. Instead of files stands one line: `:files:BEFORE:ENDINGS`, where BEFORE is what the word has before
/// the name of the file ("--output="), and no ENDINGS (".ply .pcd") stand for any. The scripts of `completion` ask for
/// it by `cloud2csg complete WORD...`.
[[nodiscard]] std::string completions(CLI::App& program, std::span<const std::string> words);

}  // namespace cloud2csg::app
