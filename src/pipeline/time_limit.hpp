#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

namespace cloud2csg {

/// A stop token that triggers with another one or at the end of a time limit, whichever comes first.
class TimeLimit {
 public:
  TimeLimit(const std::stop_token& caller, std::optional<double> seconds);

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }
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

}  // namespace cloud2csg
