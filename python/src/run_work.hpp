#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <type_traits>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg::python {

/// The keyword arguments `threads` and `progress` of a function that has work to do.
struct RunArguments {
  int threads = 0;                               ///< 0 = all cores
  pybind11::object progress = pybind11::none();  ///< callable(stage: str, done: int, total: int), or None
};

/// Calls `work` on a thread of its own, without the interpreter's lock. The calling thread, meanwhile, hands on
/// progress and looks for signals twenty times a second: an exception of either (KeyboardInterrupt...) stops the work
/// and is passed on once that has ended. `work` must not touch Python objects.
/// @throws what `work` or the callback does; ValueError for negative threads
void run_on_thread(const RunArguments& arguments, const std::function<void(const RunContext&)>& work);

/// The same for work that returns something.
template <typename Work>
auto run_work(const RunArguments& arguments, const Work& work) -> std::invoke_result_t<Work, const RunContext&> {
  std::optional<std::invoke_result_t<Work, const RunContext&>> result;
  run_on_thread(arguments, [&](const RunContext& run) { result.emplace(work(run)); });
  return *std::move(result);
}

}  // namespace cloud2csg::python
