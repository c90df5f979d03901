#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>
#include <type_traits>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg::python {

/// The keyword arguments `threads` and `progress` of functions with work to do.
struct RunArguments {
  int threads = 0;                               ///< 0 = all cores
  pybind11::object progress = pybind11::none();  ///< callable(stage: str, done: int, total: int), or None
};

/// Calls `work` on a new thread without the interpreter's lock. The calling thread passes on progress and checks for
/// signals 20 times a second. An exception of either (KeyboardInterrupt...) stops the work and is raised at its end.
/// `work` must not touch Python objects.
/// @throws exceptions of `work` and the callback; ValueError for negative threads
void run_on_thread(const RunArguments& arguments, const std::function<void(const RunContext&)>& work);

/// The same for work with a result.
template <typename Work>
auto run_work(const RunArguments& arguments, const Work& work) -> std::invoke_result_t<Work, const RunContext&> {
  std::optional<std::invoke_result_t<Work, const RunContext&>> result;
  run_on_thread(arguments, [&](const RunContext& run) { result.emplace(work(run)); });
  return *std::move(result);
}

}  // namespace cloud2csg::python
