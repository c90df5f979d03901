#pragma once

#include "cloud2csg/extract.hpp"
#include "pipeline/time_limit.hpp"

namespace cloud2csg {

/// How the stages of one extraction run. The pass over the points, without which there is no tree, goes on when the
/// time is over; the search, which always has a tree to give, stops then.
class ExtractionRun {
 public:
  /// `limit` must outlive this.
  ExtractionRun(RunContext run, Parallel parallel, const TimeLimit& limit)
      : run_(std::move(run)), parallel_(parallel), limit_(limit) {}

  [[nodiscard]] RunContext pass() const { return with_threads(parallel_ != Parallel::none); }
  /// Several partitions side by side.
  [[nodiscard]] RunContext partitions() const {
    return with_threads(parallel_ == Parallel::partitions || parallel_ == Parallel::both);
  }
  /// One search: its population in parallel, or not.
  [[nodiscard]] RunContext search() const {
    RunContext run = with_threads(parallel_ == Parallel::population || parallel_ == Parallel::both);
    run.stop = limit_.token();
    return run;
  }
  void enforce_limit() const { limit_.enforce(); }

 private:
  [[nodiscard]] RunContext with_threads(bool is_parallel) const {
    RunContext run = run_;
    if (!is_parallel) run.threads = 1;
    return run;
  }

  RunContext run_;
  Parallel parallel_;
  const TimeLimit& limit_;
};

}  // namespace cloud2csg
