#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/experiment/paper.hpp"
#include "bench/experiment/table.hpp"

namespace cloud2csg::test {

/// A folder of its own for each test, removed afterwards.
class ExperimentTest : public ::testing::Test {
 protected:
  ExperimentTest()
      : folder_(std::filesystem::temp_directory_path() / ("cloud2csg_experiment_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ExperimentTest() override { std::filesystem::remove_all(folder_); }
  ExperimentTest(const ExperimentTest&) = delete;
  ExperimentTest& operator=(const ExperimentTest&) = delete;
  ExperimentTest(ExperimentTest&&) = delete;
  ExperimentTest& operator=(ExperimentTest&&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path results_file() const { return folder_ / "paper.json"; }
  [[nodiscard]] static std::filesystem::path shipped_models() {
    return std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models";
  }
  /// An experiment of twelve runs that take milliseconds.
  [[nodiscard]] static PaperOptions small_experiment() {
    return {.models = {"m1"}, .low_points = 200, .high_points = 400, .repeats = 1, .threads = 2};
  }
  [[nodiscard]] PaperResults reproduce(const PaperOptions& options, const RunContext& run = {}) const {
    return reproduce_paper(options, shipped_models(), folder_, run);
  }

 private:
  std::filesystem::path folder_;
};

/// @throws std::out_of_range when there is none of this name.
inline const Table& table_of(const std::vector<Table>& tables, const std::string& name) {
  for (const Table& table : tables) {
    if (table.name == name) return table;
  }
  throw std::out_of_range(name);
}

}  // namespace cloud2csg::test
