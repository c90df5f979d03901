#pragma once

#include <filesystem>

namespace cloud2csg {

/// Runs gnuplot, as the search path has it, on a script that prints a picture, and puts this into a file.
/// Returns false when gnuplot is not installed. @throws Error with its first words when it fails.
[[nodiscard]] bool run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& picture);

}  // namespace cloud2csg
