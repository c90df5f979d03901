#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace cloud2csg {

/// A stop token that is triggered by another one, or when a time limit is over, whichever comes first.
class TimeLimit {
 public:
  TimeLimit(const std::stop_token& caller, std::optional<double> seconds);

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
  /// Triggers the token when the limit is over: on a busy machine, the thread that is to do it may be late.
  void enforce() const;

 private:
  struct RequestStop {
    std::stop_source source;
    void operator()() { source.request_stop(); }
  };

  std::optional<std::chrono::steady_clock::time_point> end_;
  mutable std::stop_source source_;  // to request a stop does not change what this stands for
  std::stop_callback<RequestStop> on_caller_;
  std::mutex mutex_;
  std::condition_variable_any timer_;
  std::jthread watch_;  // last: it stops and joins before the rest goes
};

}  // namespace cloud2csg
