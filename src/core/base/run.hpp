#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Wall-clock time.
class Stopwatch {
 public:
  /// Seconds since construction or the last lap().
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /// As seconds(); then starts again at zero.
  double lap() {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point start_ = Clock::now();
};

/// For short work that an interrupted search still needs, such as the fit of its tree.
[[nodiscard]] inline RunContext without_stop(RunContext run) {
  run.stop = {};
  return run;
}

/// A loop's share of a stage. Progress counts as if the stage's loops ran one after the other.
class StageShare {
 public:
  /// Reports nothing.
  StageShare() = default;
  /// A whole stage of `total` things.
  StageShare(std::string_view stage, std::size_t total, std::string_view unit)
      : stage_(stage), total_(total), unit_(unit) {}

  /// The part of this share between two fractions of it, each from 0 to 1.
  [[nodiscard]] StageShare part(double from, double to) const {
    StageShare result = *this;
    result.from_ = from_ + from * (to_ - from_);
    result.to_ = from_ + to * (to_ - from_);
    return result;
  }

  /// Reports that the fraction `done` of this share is done. Reporting 1 for a whole stage ends the stage.
  void report(const RunContext& run, double done) const {
    if (stage_.empty()) return;
    const double things = static_cast<double>(total_) * (from_ + done * (to_ - from_));
    run.report(stage_, static_cast<std::size_t>(std::round(things)), total_, unit_);
  }

 private:
  std::string_view stage_ = {};
  std::size_t total_ = 0;
  std::string_view unit_ = {};
  double from_ = 0;
  double to_ = 1;
};

}  // namespace cloud2csg
