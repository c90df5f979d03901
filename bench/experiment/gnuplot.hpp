#pragma once

#include <filesystem>

namespace cloud2csg {

/// Writes the picture that a gnuplot script prints; false without gnuplot. @throws Error with gnuplot's message.
[[nodiscard]] bool run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& picture);

}  // namespace cloud2csg
