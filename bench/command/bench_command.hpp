#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "command.hpp"
#include "field_arguments.hpp"

namespace cloud2csg::app {

// Each adds its subcommand to bench; one file per experiment.
[[nodiscard]] Command add_bench_paper(CLI::App& bench);
[[nodiscard]] Command add_bench_compare(CLI::App& bench);
[[nodiscard]] Command add_bench_scaling(CLI::App& bench);

/// `-o DIR`
void add_results_folder(CLI::App& app, std::string& folder);
/// @throws Error
void make_folder(const std::filesystem::path& folder);

[[nodiscard]] int threads_of(const RunOptions& running);

/// The result of `work`. When interrupted, tells how to continue.
template <typename Work>
auto resumable(const std::string& folder, Session& session, const Work& work) {
  try {
    return work();
  } catch (const Cancelled&) {
    session.display().note("finished runs are kept in " + folder + "; the same command makes the missing ones");
    throw;
  }
}

}  // namespace cloud2csg::app
