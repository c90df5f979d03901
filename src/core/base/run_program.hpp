#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace cloud2csg {

enum class RunEnd { done, failed, too_late, not_installed };

/// Runs a program that the system finds by its name, without a shell and without input, and waits for it. Its output
/// and its complaints go to files that are there. After `limit` it is killed.
/// @throws Error where it is there and cannot be run
[[nodiscard]] RunEnd run_program(std::vector<std::string> command, const std::filesystem::path& output,
                                 const std::filesystem::path& complaints, std::chrono::seconds limit);

}  // namespace cloud2csg
