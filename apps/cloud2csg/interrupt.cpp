#include "interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <system_error>

#include "core/base/files.hpp"

namespace cloud2csg::app {
namespace {

constexpr int k_status_interrupted = 130;  // 128 + SIGINT, as shells count
constexpr char k_byte_interrupt = 'i';
constexpr char k_byte_quit = 'q';

// A signal handler has no argument: this is the one way to reach it.
std::atomic<int> pipe_write_end = -1;   // NOLINT(readability-identifier-naming)
std::atomic<bool> is_stopping = false;  // NOLINT(readability-identifier-naming)
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "only lock-free atomics may be used in a signal handler");

/// Only async-signal-safe calls: std::stop_source::request_stop() runs callbacks and may take locks, so the watcher
/// thread calls it.
extern "C" void on_interrupt(int /*signal*/) {
  if (is_stopping.exchange(true)) {
    remove_temporaries();
    ::_exit(k_status_interrupted);
  }
  const int saved = errno;
  [[maybe_unused]] const ssize_t written = ::write(pipe_write_end.load(), &k_byte_interrupt, 1);
  errno = saved;
}

}  // namespace

InterruptWatcher::InterruptWatcher() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  pipe_read_ = ends[0];
  pipe_write_end = ends[1];
  is_stopping = false;
  watcher_ = std::thread([this] {
    char byte = k_byte_quit;
    while (::read(pipe_read_, &byte, 1) < 0 && errno == EINTR) {
    }
    if (byte == k_byte_interrupt) stop_.request_stop();
  });
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, &old_interrupt_);
  ::sigaction(SIGTERM, &action, &old_terminate_);
  ::sigaction(SIGHUP, &action, &old_hang_up_);
}

InterruptWatcher::~InterruptWatcher() {
  ::sigaction(SIGINT, &old_interrupt_, nullptr);
  ::sigaction(SIGTERM, &old_terminate_, nullptr);
  ::sigaction(SIGHUP, &old_hang_up_, nullptr);
  const int write_end = pipe_write_end.exchange(-1);
  [[maybe_unused]] const ssize_t written = ::write(write_end, &k_byte_quit, 1);
  watcher_.join();
  ::close(write_end);
  ::close(pipe_read_);
}

}  // namespace cloud2csg::app
