#include "core/base/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr int k_most_trials = 100;

// Global for the signal handler. Few files live at once. A signal does not remove a file without an entry.
constexpr std::size_t k_entries = 64;
std::array<std::atomic<const char*>, k_entries> live_paths = {};  // NOLINT(readability-identifier-naming)
static_assert(std::atomic<const char*>::is_always_lock_free, "only lock-free atomics may be used in a signal handler");

/// Stands in all entries after the handler has run.
constexpr char k_closed = '\0';

[[noreturn]] void wait_for_the_end() {
  for (;;) ::pause();
}

/// Exchanges two files in one step. False when one is missing or the file system cannot exchange files.
bool exchange(const std::filesystem::path& a, const std::filesystem::path& b) {
#ifdef RENAME_EXCHANGE
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  return false;
#endif
}

}  // namespace

TemporaryFile::TemporaryFile(const std::filesystem::path& destination, std::string_view ending) {
  for (int trial = 0;; ++trial) {
    path_ = fmt::format("{}.{}.{}.part{}", destination.string(), ::getpid(), trial, ending);
    // Enter first, so that no signal finds a file that is not in the register.
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

ScratchFile::ScratchFile(std::string_view ending) {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error) / "cloud2csg";
  if (error) refuse_output("the folder for temporary files", "is missing", error.value());
  try {
    file_.emplace(place, ending);
  } catch (const std::system_error& failure) {
    refuse_output(place, "cannot be written", failure.code().value());
  }
}

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  const Destination destination = destination_of(target_);
  place_ = destination.path;
  try {
    if (!destination.is_direct) temporary_.emplace(place_);
  } catch (const std::system_error& error) {
    refuse_output(target_, "cannot be opened for writing", error.code().value());
  }
  file_ = std::fopen(temporary_ ? temporary_->path().c_str() : target_.c_str(), "wb");
  if (file_ == nullptr) fail("cannot be opened for writing");
}

AtomicFile::~AtomicFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
}

void AtomicFile::commit() {
  const int flushed = std::fflush(file_);
  const int synced = flushed == 0 ? ::fsync(::fileno(file_)) : flushed;
  // Pipes, terminals and some network file systems cannot be synced. No data is lost.
  if (flushed != 0 || (synced != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP)) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot be written");
  if (!temporary_) return;
  if (std::rename(temporary_->path().c_str(), place_.c_str()) != 0) fail("cannot be moved into place");
  temporary_.reset();
}

void AtomicFile::fail(const char* what) const {
  refuse_output(target_, what, errno);
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  AtomicFile out(file);
  out.write(text);
  out.commit();
}

std::string read_text_file(const std::filesystem::path& file) {
  const auto fail = [&file](int reason) {
    throw Error({.file = file.string(),
                 .expected = fmt::format("cannot be read ({})", std::strerror(reason)),
                 .remedy = "check the path and its permissions"});
  };
  std::FILE* in = std::fopen(file.c_str(), "rb");
  if (in == nullptr) fail(errno);
  std::string text;
  std::vector<char> buffer(std::size_t{1} << 16);
  std::size_t got = 0;
  while ((got = std::fread(buffer.data(), 1, buffer.size(), in)) > 0) text.append(buffer.data(), got);
  const int reason = std::ferror(in) != 0 ? errno : 0;
  std::fclose(in);
  if (reason != 0) fail(reason);
  return text;
}

struct OutputSet::Entry {
  Entry(std::filesystem::path given, std::filesystem::path resolved)
      : target(std::move(given)), place(std::move(resolved)), staged(place, target.extension().string()) {}

  /// Exchanges an older file with the new one, so that take_back() can restore the older one.
  void put_in_place() {
    is_exchanged = exchange(staged.path(), place);
    if (!is_exchanged && std::rename(staged.path().c_str(), place.c_str()) != 0) {
      refuse_output(target, "cannot be moved into place", errno);
    }
  }

  void take_back() const {
    if (is_exchanged) {
      exchange(staged.path(), place);
    } else {
      std::rename(place.c_str(), staged.path().c_str());
    }
  }

  std::filesystem::path target;  ///< as the caller names it
  std::filesystem::path place;   ///< `target` with links followed
  TemporaryFile staged;
  bool is_exchanged = false;
};

OutputSet::OutputSet() = default;
OutputSet::~OutputSet() = default;

void OutputSet::add(const std::filesystem::path& target,
                    const std::function<void(const std::filesystem::path&)>& write) {
  const Destination destination = destination_of(target);
  if (destination.is_direct) {
    write(target);
    return;
  }
  try {
    entries_.push_back(std::make_unique<Entry>(target, destination.path));
  } catch (const std::system_error& error) {
    refuse_output(target, "cannot be opened for writing", error.code().value());
  }
  const std::filesystem::path& staged = entries_.back()->staged.path();
  try {
    write(staged);
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    if (parts.file == staged.string()) parts.file = target.string();
    throw Error(std::move(parts));
  }
}

void OutputSet::commit() {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    try {
      (*entry)->put_in_place();
    } catch (const Error&) {
      for (auto placed = std::make_reverse_iterator(entry); placed != entries_.rend(); ++placed) (*placed)->take_back();
      throw;
    }
  }
  entries_.clear();
}

}  // namespace cloud2csg
