#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

/// Runs the built command line as a user does.
namespace cloud2csg::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + signal when a signal ended it
  std::string out;
  std::string err;
};

/// A program that is running. Precondition: wait() is called exactly once.
class RunningProgram {
 public:
  RunningProgram(pid_t pid, std::filesystem::path out, std::filesystem::path err)
      : pid_(pid), out_(std::move(out)), err_(std::move(err)) {}
  void send_signal(int signal) const;
  [[nodiscard]] std::string out_so_far() const;
  [[nodiscard]] std::string err_so_far() const;
  [[nodiscard]] Outcome wait();

 private:
  pid_t pid_;
  std::filesystem::path out_, err_;
};

/// A folder of its own for each test, removed afterwards.
class ProgramTest : public ::testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;
  ProgramTest(const ProgramTest&) = delete;
  ProgramTest& operator=(const ProgramTest&) = delete;
  ProgramTest(ProgramTest&&) = delete;
  ProgramTest& operator=(ProgramTest&&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes a file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& content) const;
  /// A model file that the project ships.
  [[nodiscard]] static std::string shipped(const std::string& name);

  /// Starts the program with these arguments. `shell_setup` runs before it in its shell, e.g. "ulimit -f 8".
  /// `error_file`: where standard error goes, when not into the outcome.
  [[nodiscard]] RunningProgram start(const std::vector<std::string>& arguments, const std::string& shell_setup = "true",
                                     const std::string& error_file = "");
  [[nodiscard]] Outcome run(const std::vector<std::string>& arguments, const std::string& shell_setup = "true");

  /// Intersection over union of two model files, by `compare`.
  [[nodiscard]] double iou(const std::string& truth, const std::string& result);

  /// Names of the files in the test's folder, ascending, without those of the test itself.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path folder_;
  std::filesystem::path capture_;  ///< of the captured output, beside the folder
  int runs_ = 0;
};

[[nodiscard]] std::string read_file(const std::filesystem::path& file);

/// Asserts the contract of failure: this status, nothing on standard output, one line on standard error that starts
/// with the program's name and holds all of `parts`.
void expect_failure(const Outcome& outcome, int status, const std::vector<std::string>& parts);

}  // namespace cloud2csg::test
