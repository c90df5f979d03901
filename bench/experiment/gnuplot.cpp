#include "bench/experiment/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "cloud2csg/error.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/temporary_file.hpp"

namespace cloud2csg {
namespace {

/// Where a subprocess reads from and writes to.
class Redirections {
 public:
  Redirections(const std::filesystem::path& out, const std::filesystem::path& err) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, 1, out.c_str(), O_WRONLY | O_TRUNC, 0);
    ::posix_spawn_file_actions_addopen(&actions_, 2, err.c_str(), O_WRONLY | O_TRUNC, 0);
  }
  ~Redirections() { ::posix_spawn_file_actions_destroy(&actions_); }
  Redirections(const Redirections&) = delete;
  Redirections& operator=(const Redirections&) = delete;
  Redirections(Redirections&&) = delete;
  Redirections& operator=(Redirections&&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_ = {};
};

/// The line of gnuplot's complaint that says what is wrong: the last that is not empty.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return "it does not say why";
  const std::size_t before = text.find_last_of('\n', end);
  const std::size_t start = before == std::string::npos ? 0 : before + 1;
  return text.substr(start, end + 1 - start);
}

[[noreturn]] void refuse(const std::filesystem::path& script, const std::string& reason) {
  throw Error({.file = script.string(), .where = {}, .expected = "gnuplot failed: " + reason, .remedy = {}});
}

}  // namespace

bool run_gnuplot(const std::filesystem::path& script, const std::filesystem::path& picture) {
  const TemporaryFile complaint(picture, ".txt");
  const Redirections redirections(picture, complaint.path());
  std::string program = "gnuplot";
  std::string argument = script.string();
  const std::array<char*, 3> arguments{program.data(), argument.data(), nullptr};
  pid_t process = 0;
  const int failure = ::posix_spawnp(&process, program.c_str(), redirections.get(), nullptr, arguments.data(), environ);
  if (failure == ENOENT) return false;
  if (failure != 0) refuse(script, std::strerror(failure));
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) continue;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) refuse(script, last_line(read_text_file(complaint.path())));
  return true;
}

}  // namespace cloud2csg
