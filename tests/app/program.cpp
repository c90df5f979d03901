#include "app/program.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

extern char** environ;

namespace cloud2csg::test {
namespace {

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

pid_t spawn_shell(const std::string& script) {
  std::string shell = "/bin/sh";
  std::string option = "-c";
  std::string text = script;
  char* arguments[] = {shell.data(), option.data(), text.data(), nullptr};
  pid_t pid = -1;
  if (::posix_spawn(&pid, shell.c_str(), nullptr, nullptr, arguments, environ) != 0) {
    throw std::runtime_error("cannot start /bin/sh");
  }
  return pid;
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void RunningProgram::send_signal(int signal) const {
  ::kill(pid_, signal);
}

std::string RunningProgram::out_so_far() const {
  return read_file(out_);
}

std::string RunningProgram::err_so_far() const {
  return read_file(err_);
}

Outcome RunningProgram::wait() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          .out = read_file(out_),
          .err = read_file(err_)};
}

ProgramTest::ProgramTest() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(info->test_suite_name()) + "_" + info->name() + "_" + std::to_string(::getpid());
  std::replace(name.begin(), name.end(), '/', '_');
  folder_ = std::filesystem::path(::testing::TempDir()) / name;
  capture_ = std::filesystem::path(::testing::TempDir()) / (name + "_output");
  std::filesystem::create_directories(folder_);
  std::filesystem::create_directories(capture_);
}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
  std::filesystem::remove_all(capture_, ignored);
}

std::string ProgramTest::file(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
  return path(name);
}

std::string ProgramTest::shipped(const std::string& name) {
  return std::string(CLOUD2CSG_DATA_DIR) + "/models/" + name;
}

RunningProgram ProgramTest::start(const std::vector<std::string>& arguments, const std::string& shell_setup,
                                  const std::string& error_file) {
  const std::string number = std::to_string(runs_++);
  const std::filesystem::path out = capture_ / (number + ".out");
  const std::filesystem::path err =
      error_file.empty() ? capture_ / (number + ".err") : std::filesystem::path(error_file);
  std::string script = shell_setup + "; exec " + quoted(CLOUD2CSG_PROGRAM);
  for (const std::string& argument : arguments) script += " " + quoted(argument);
  script += " >" + quoted(out.string()) + " 2>" + quoted(err.string());
  return {spawn_shell(script), out, error_file.empty() ? err : std::filesystem::path("/dev/null")};
}

Outcome ProgramTest::run(const std::vector<std::string>& arguments, const std::string& shell_setup) {
  return start(arguments, shell_setup).wait();
}

double ProgramTest::iou(const std::string& truth, const std::string& result) {
  const Outcome compared = run({"compare", truth, result, "--json", "--resolution", "96", "--samples", "2000"});
  EXPECT_EQ(compared.status, 0) << compared.err;
  return nlohmann::json::parse(compared.out)["intersection_over_union"].get<double>();
}

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void expect_failure(const Outcome& outcome, int status, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err.rfind("cloud2csg: ", 0), 0U) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& part : parts) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.err;
  }
}

}  // namespace cloud2csg::test
