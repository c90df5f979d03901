#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

namespace cloud2csg {

/// How far a stage has come. `total` is 0 when it is not known in advance.
struct Progress {
  std::string_view stage;  ///< as in the statistics: "read", "overlap", "classes", "search"...
  std::size_t done = 0;
  std::size_t total = 0;
  /// What is counted, in the plural: "points", "primitives"... Empty where the counts are steps that mean nothing to a
  /// user. A stage with a unit has done all of `total` when the next one starts.
  std::string_view unit = {};
};

/// How to run, never what to compute: the result does not depend on anything in here, except that a
/// triggered stop token ends the work early. The seed is an option of the stage that uses it.
struct RunContext {
  std::stop_token stop = {};
  /// Called from the thread that called the library, or from one worker at a time.
  std::function<void(const Progress&)> on_progress = {};
  int threads = 1;  ///< 0 = all cores

  /// @throws Cancelled when the stop token was triggered.
  void throw_if_stopped() const;
  void report(std::string_view stage, std::size_t done, std::size_t total, std::string_view unit = {}) const;
};

}  // namespace cloud2csg
