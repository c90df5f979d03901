#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cloud2csg/error.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg::app {

/// What is wrong with the command line, and found only when the command runs.
class WrongUsage : public Error {
 public:
  using Error::Error;
};

/// Which command takes a file of this kind, where another one was given it.
[[nodiscard]] const char* taker_of(FileKind kind);

/// Whether a command was named that is only the first word of others, and nothing behind it.
[[nodiscard]] bool lacks_command(const CLI::App& program);

/// One line that says what is wrong with the command line, with the nearest right name for a wrong one.
[[nodiscard]] std::string usage_message(const CLI::App& program, const CLI::ParseError& error);

/// CLI11's message in clearer words, where it has none.
[[nodiscard]] std::string reworded(const CLI::ParseError& error);

/// How many letters must be inserted, deleted, replaced or swapped with their neighbour to turn one word into the
/// other.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to `word`; empty when none is near enough to be meant.
[[nodiscard]] std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

}  // namespace cloud2csg::app
