#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

namespace cloud2csg {

/// Progress of a stage. `total` is 0 when it is not known in advance.
struct Progress {
  std::string_view stage;  ///< name as in the statistics: "read", "overlap", "classes", "search"...
  std::size_t done = 0;
  std::size_t total = 0;
  /// The counted things in the plural: "points", "primitives"... Empty where the counts mean nothing to a user. A stage
  /// with a unit has reached `total` when the next one starts.
  std::string_view unit = {};
};

/// How to run. Nothing here changes the result, except that a triggered stop token ends the work early.
struct RunContext {
  std::stop_token stop = {};
  /// Called by the calling thread, or by one worker at a time.
  std::function<void(const Progress&)> on_progress = {};
  int threads = 1;  ///< 0 = all cores

  /// @throws Cancelled when the stop token was triggered.
  void throw_if_stopped() const;
  void report(std::string_view stage, std::size_t done, std::size_t total, std::string_view unit = {}) const;
};

}  // namespace cloud2csg
