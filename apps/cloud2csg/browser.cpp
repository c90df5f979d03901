#include "browser.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every unistd.h

namespace cloud2csg::app {
namespace {

/// Whether it ends within a second, and says that it failed. What goes on, as a browser may, is not waited for.
bool fails_soon(pid_t child) {
  using namespace std::chrono_literals;
  for (int tenth = 0; tenth < 10; ++tenth) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return !WIFEXITED(status) || WEXITSTATUS(status) != 0;
    std::this_thread::sleep_for(100ms);
  }
  std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
  return false;
}

}  // namespace

bool open_in_browser(const std::string& address) {
  const bool has_desktop = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  if (!has_desktop) return false;
  std::string program = "xdg-open";
  std::string argument = address;
  std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  pid_t child = -1;
  const int status = ::posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (status != 0) return false;
  return !fails_soon(child);
}

}  // namespace cloud2csg::app
