#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace cloud2csg::app {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP requests a stop and the second ends the program at once, with
/// status 130, less the temporary files that it was writing. At most one at a time.
class InterruptWatcher {
 public:
  InterruptWatcher();
  ~InterruptWatcher();
  InterruptWatcher(const InterruptWatcher&) = delete;
  InterruptWatcher& operator=(const InterruptWatcher&) = delete;
  InterruptWatcher(InterruptWatcher&&) = delete;
  InterruptWatcher& operator=(InterruptWatcher&&) = delete;

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  struct sigaction old_interrupt_ = {};
  struct sigaction old_terminate_ = {};
  struct sigaction old_hang_up_ = {};
  int pipe_read_ = -1;
  std::thread watcher_;
};

}  // namespace cloud2csg::app
