#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "cloud2csg/run_context.hpp"
#include "core/base/run.hpp"

namespace cloud2csg {

/// A stop token that triggers with another one or at the end of a time limit, whichever comes first.
class TimeLimit {
 public:
  TimeLimit(const std::stop_token& caller, std::optional<double> seconds);

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  /// The run, which stops with the token.
  [[nodiscard]] RunContext limited(RunContext run) const {
    run.stop = token();
    return run;
  }
  /// Triggers the token if the limit is over. The watching thread may be late on a busy machine.
  void enforce() const;

 private:
  struct RequestStop {
    std::stop_source source;
    void operator()() { source.request_stop(); }
  };

  std::optional<std::chrono::steady_clock::time_point> end_;
  mutable std::stop_source source_;  // a request to stop does not change the object's value
  std::stop_callback<RequestStop> on_caller_;
  std::mutex mutex_;
  std::condition_variable_any timer_;
  std::jthread watch_;  // last member: stops and joins before the others are destroyed
};

/// In seconds. Options refuse a limit of zero.
inline constexpr double k_next_to_nothing = 1e-9;

/// What the watch has left of a limit, at least next to nothing.
[[nodiscard]] std::optional<double> seconds_left(std::optional<double> limit, const Stopwatch& watch);

}  // namespace cloud2csg
