#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace cloud2csg {

enum class RunEnd { done, failed, too_late, not_installed };

/// Runs a program found by its name, without a shell and without input, and waits for it. Output and complaints go to
/// existing files. Kills it after `limit`. @throws Error where the program exists and cannot be run
[[nodiscard]] RunEnd run_program(std::vector<std::string> command, const std::filesystem::path& output,
                                 const std::filesystem::path& complaints, std::chrono::seconds limit);

}  // namespace cloud2csg
