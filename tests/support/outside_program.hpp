#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

/// Programs that read what was written.
namespace cloud2csg::test {

/// A folder of its own, gone with the object.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cloud2csg_test_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ScratchFolder(ScratchFolder&&) = delete;
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string content_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;  // NOLINT: a fixed name
}

struct Run {
  int status;
  std::string output;  ///< and what it says on standard error
};

/// Runs a command of the shell in a folder, without input.
inline Run run_in(const ScratchFolder& folder, const std::string& command) {
  const std::string log = folder.file("log").string();
  const std::string line =
      "cd '" + folder.path().string() + "' && { " + command + "; } > '" + log + "' 2>&1 < /dev/null";
  const int status = std::system(line.c_str());  // NOLINT: our own names
  return {.status = status, .output = content_of(log)};
}

/// Runs a Python script of ours against modules that stand for the CAD program's: see fake_cad/judge.py.
inline Run judge(const ScratchFolder& folder, const std::string& script, const std::string& points) {
  const std::filesystem::path judge =
      std::filesystem::path(CLOUD2CSG_DATA_DIR).parent_path() / "tests" / "scripts" / "fake_cad" / "judge.py";
  return run_in(folder, "PYTHONDONTWRITEBYTECODE=1 python3 '" + judge.string() + "' " + script + " " + points);
}

}  // namespace cloud2csg::test
