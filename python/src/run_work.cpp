#include "run_work.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace cloud2csg::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds k_signal_interval{50};

struct Message {
  std::string stage;
  std::size_t done, total;
};

/// Messages from the working thread to the waiting one.
class Mailbox {
 public:
  /// Keeps only the last unread message of a stage.
  void put(const Progress& progress) {
    {
      const std::lock_guard lock(mutex_);
      if (messages_.empty() || messages_.back().stage != progress.stage) messages_.emplace_back();
      messages_.back() = {.stage = std::string(progress.stage), .done = progress.done, .total = progress.total};
    }
    changed_.notify_one();
  }

  void finish() {
    {
      const std::lock_guard lock(mutex_);
      is_finished_ = true;
    }
    changed_.notify_one();
  }

  /// Messages since the last call, and whether the work has finished. Waits briefly when there are none.
  std::pair<std::vector<Message>, bool> wait() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, k_signal_interval, [&] { return is_finished_ || !messages_.empty(); });
    return {std::exchange(messages_, {}), is_finished_};
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Message> messages_;
  bool is_finished_ = false;
};

/// The interpreter's lock is held on entry and on return.
void hand_on(Mailbox& mailbox, const py::object& progress) {
  bool is_finished = false;
  while (!is_finished) {
    std::vector<Message> messages;
    {
      const py::gil_scoped_release unlocked;
      std::tie(messages, is_finished) = mailbox.wait();
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    for (const Message& message : messages) progress(message.stage, message.done, message.total);
  }
}

}  // namespace

void run_on_thread(const RunArguments& arguments, const std::function<void(const RunContext&)>& work) {
  if (arguments.threads < 0) throw py::value_error("threads: expected 0 (all cores) or more");
  if (!arguments.progress.is_none() && PyCallable_Check(arguments.progress.ptr()) == 0) {
    throw py::type_error("progress: expected a callable(stage, done, total) or None");
  }
  Mailbox mailbox;
  std::stop_source stop;
  RunContext run{.stop = stop.get_token(), .on_progress = {}, .threads = arguments.threads};
  if (!arguments.progress.is_none()) run.on_progress = [&](const Progress& progress) { mailbox.put(progress); };
  std::exception_ptr failure;
  std::thread worker([&] {
    try {
      work(run);
    } catch (...) {
      failure = std::current_exception();
    }
    mailbox.finish();
  });
  const auto join = [&] {
    const py::gil_scoped_release unlocked;
    worker.join();
  };
  try {
    hand_on(mailbox, arguments.progress);
  } catch (...) {
    stop.request_stop();
    join();
    throw;
  }
  join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace cloud2csg::python
