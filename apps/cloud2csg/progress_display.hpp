#pragma once

#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg::app {

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

}  // namespace cloud2csg::app
