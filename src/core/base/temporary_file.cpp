#include "core/base/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr int k_most_trials = 100;

// A signal handler has no argument: this is the one way to tell it what to remove. Few files are written at once; one
// that finds no free entry is only not removed by a signal.
constexpr std::size_t k_entries = 64;
std::array<std::atomic<const char*>, k_entries> live_paths = {};  // NOLINT(readability-identifier-naming)
static_assert(std::atomic<const char*>::is_always_lock_free, "only lock-free atomics may be used in a signal handler");

/// Stands in all entries once the handler has been there.
constexpr char k_closed = '\0';

[[noreturn]] void wait_for_the_end() {
  for (;;) ::pause();
}

}  // namespace

TemporaryFile::TemporaryFile(const std::filesystem::path& destination, std::string_view ending) {
  for (int trial = 0;; ++trial) {
    path_ = fmt::format("{}.{}.{}.part{}", destination.string(), ::getpid(), trial, ending);
    // First, so that no signal finds a file that is not in the register.
    enter_register();
    const int file = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return;
    }
    const int reason = errno;
    leave_register();
    if (reason != EEXIST || trial == k_most_trials) throw std::system_error(reason, std::generic_category());
  }
}

TemporaryFile::~TemporaryFile() {
  ::unlink(path_.c_str());
  leave_register();
}

void TemporaryFile::enter_register() {
  for (std::atomic<const char*>& entry : live_paths) {
    const char* found = nullptr;
    if (entry.compare_exchange_strong(found, path_.c_str())) {
      entry_ = &entry;
      return;
    }
    if (found == &k_closed) wait_for_the_end();
  }
}

void TemporaryFile::leave_register() {
  if (entry_ == nullptr) return;
  // The handler may still be reading the name.
  if (entry_->exchange(nullptr) == &k_closed) wait_for_the_end();
  entry_ = nullptr;
}

void remove_temporaries() noexcept {
  for (std::atomic<const char*>& entry : live_paths) {
    const char* path = entry.exchange(&k_closed);
    if (path != nullptr && path != &k_closed) ::unlink(path);
  }
}

Destination destination_of(const std::filesystem::path& target) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(target, ignored);
  if (std::filesystem::is_directory(status)) refuse_output(target, "cannot be written", EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return {.path = target, .is_direct = true};
  }
  std::error_code unresolved;
  const std::filesystem::path resolved = std::filesystem::canonical(target, unresolved);
  return {.path = unresolved ? target : resolved, .is_direct = false};
}

void refuse_output(const std::filesystem::path& target, std::string_view what, int reason) {
  throw Error({.file = target.string(),
               .expected = fmt::format("{} ({})", what, std::strerror(reason)),
               .remedy = "check the folder, its permissions and the free space"});
}

}  // namespace cloud2csg
