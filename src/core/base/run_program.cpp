#include "core/base/run_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

/// Returns 0 or an errno.
int start(pid_t& process, std::vector<std::string>& command, const std::filesystem::path& output,
          const std::filesystem::path& complaints) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_TRUNC, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_TRUNC, 0);
  const int failure = ::posix_spawnp(&process, words.front(), &actions, nullptr, words.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  return failure;
}

}  // namespace

RunEnd run_program(std::vector<std::string> command, const std::filesystem::path& output,
                   const std::filesystem::path& complaints, std::chrono::seconds limit) {
  using Clock = std::chrono::steady_clock;
  pid_t process = 0;
  const int failure = start(process, command, output, complaints);
  if (failure == ENOENT) return RunEnd::not_installed;
  if (failure != 0) {
    throw Error({.file = command.front(), .expected = fmt::format("cannot be run ({})", std::strerror(failure))});
  }
  const Clock::time_point end = Clock::now() + limit;
  int status = 0;
  pid_t ended = 0;
  while ((ended = ::waitpid(process, &status, WNOHANG)) == 0 && Clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (ended == 0) {
    ::kill(process, SIGKILL);
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
    return RunEnd::too_late;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? RunEnd::done : RunEnd::failed;
}

}  // namespace cloud2csg
