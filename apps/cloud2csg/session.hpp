#pragma once

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "cloud2csg/run_context.hpp"

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
  std::array<struct sigaction, 3> old_ = {};  ///< what each signal did
  int pipe_read_ = -1;
  std::thread watcher_;
};

enum class ProgressStyle {
  none,   ///< says nothing
  lines,  ///< one line a stage, when it has ended: for logs
  bar,    ///< the running stage as a bar that is drawn over, on a terminal
  color_bar,
};

/// `bar` only when the file is a terminal that can move its cursor; with colour unless NO_COLOR is set (no-color.org).
[[nodiscard]] ProgressStyle progress_style(std::FILE* out, bool quiet);

using ProgressClock = std::chrono::steady_clock;

/// Shows how far the stages are. A stage ends when all of it is done, when the next one starts, or with finish(); its
/// time is counted from the end of the one before. Stages that count something get counts, rate and the time left:
///
///     read         [#########.....................]  30 %  4.1 M points/s  2 s left
///     read         2.441 s  10000000 points, 4.1 M points/s
class ProgressDisplay {
 public:
  /// `now` tells the time.
  ProgressDisplay(std::FILE* out, ProgressStyle style,
                  std::function<ProgressClock::time_point()> now = &ProgressClock::now);
  /// Ends the running stage; one that was left by an exception has not ended and gets no line.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ProgressDisplay(ProgressDisplay&&) = delete;
  ProgressDisplay& operator=(ProgressDisplay&&) = delete;

  void update(const Progress& progress);
  /// Ends the running stage and prints a line of its own.
  void note(std::string_view line);
  /// Ends the running stage.
  void finish();

 private:
  /// Work does not end because nobody reads of its progress: nothing is thrown.
  void put(const std::string& text) const;
  [[nodiscard]] bool has_bar() const { return style_ == ProgressStyle::bar || style_ == ProgressStyle::color_bar; }
  [[nodiscard]] std::string bar(const Progress& progress, double seconds) const;
  void draw(const Progress& progress, ProgressClock::time_point now);

  std::FILE* out_;
  ProgressStyle style_;
  std::function<ProgressClock::time_point()> now_;
  std::string stage_;      ///< the running one; empty for none
  std::string ended_;      ///< the last one that ended
  std::string unit_;       ///< of what the running one counts; empty for nothing
  std::size_t count_ = 0;  ///< of these, as far as it is known
  ProgressClock::time_point stage_start_;
  ProgressClock::time_point last_drawn_ = {};
};

/// Options that every subcommand with work to do has.
struct RunOptions {
  int threads = 0;  ///< 0 = all cores
  bool quiet = false;
};

/// Progress on standard error while it lives.
class Session {
 public:
  Session(const RunOptions& options, std::stop_token stop);
  [[nodiscard]] const RunContext& run() const { return run_; }
  [[nodiscard]] ProgressDisplay& display() { return display_; }
  /// A note each.
  void warn(const std::vector<std::string>& warnings);

 private:
  ProgressDisplay display_;
  RunContext run_;
};

}  // namespace cloud2csg::app
