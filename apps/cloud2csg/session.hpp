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

/// During its lifetime, the first SIGINT, SIGTERM or SIGHUP requests a stop. The second removes temporary files and
/// ends the program with status 130. At most one object at a time.
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
  std::array<struct sigaction, 3> old_ = {};  ///< previous actions
  int pipe_read_ = -1;
  std::thread watcher_;
};

enum class ProgressStyle {
  none,
  lines,  ///< one line per completed stage, for logs
  bar,    ///< the running stage as a redrawn bar, on a terminal
  color_bar,
};

/// `bar` if the file is a terminal with cursor control, with colour unless NO_COLOR is set (no-color.org).
[[nodiscard]] ProgressStyle progress_style(std::FILE* out, bool quiet);

using ProgressClock = std::chrono::steady_clock;

/// Shows the progress of stages. A stage ends when all of it is done, when the next one starts, or with finish(). Its
/// time starts at the end of the previous one. Stages with a unit show counts, rate and remaining time:
///
///     read         [#########.....................]  30 %  4.1 M points/s  2 s left
///     read         2.441 s  10000000 points, 4.1 M points/s
class ProgressDisplay {
 public:
  ProgressDisplay(std::FILE* out, ProgressStyle style,
                  std::function<ProgressClock::time_point()> now = &ProgressClock::now);
  /// Ends the running stage, unless an exception left it: then it gets no line.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;
  ProgressDisplay(ProgressDisplay&&) = delete;
  ProgressDisplay& operator=(ProgressDisplay&&) = delete;

  void update(const Progress& progress);
  /// Ends the running stage and prints the line; in style `none` it prints nothing.
  void note(std::string_view line);
  /// The same in every style.
  void say(std::string_view line);
  void finish();

 private:
  /// Throws nothing: work goes on when nobody reads the progress.
  void put(const std::string& text) const;
  [[nodiscard]] bool has_bar() const { return style_ == ProgressStyle::bar || style_ == ProgressStyle::color_bar; }
  [[nodiscard]] std::string bar(const Progress& progress, double seconds) const;
  void draw(const Progress& progress, ProgressClock::time_point now);

  std::FILE* out_;
  ProgressStyle style_;
  std::function<ProgressClock::time_point()> now_;
  std::string stage_;      ///< running stage; empty: none
  std::string ended_;      ///< last completed stage
  std::string unit_;       ///< unit of the running stage; empty: none
  std::size_t count_ = 0;  ///< counted units so far
  ProgressClock::time_point stage_start_;
  ProgressClock::time_point last_drawn_ = {};
};

/// Options of every subcommand with work to do.
struct RunOptions {
  int threads = 0;  ///< 0 = all cores
  bool quiet = false;
};

/// Shows progress on standard error during its lifetime.
class Session {
 public:
  Session(const RunOptions& options, std::stop_token stop);
  [[nodiscard]] const RunContext& run() const { return run_; }
  [[nodiscard]] ProgressDisplay& display() { return display_; }
  /// Not silenced by `quiet`.
  void warn(const std::vector<std::string>& warnings);

 private:
  ProgressDisplay display_;
  RunContext run_;
};

}  // namespace cloud2csg::app
