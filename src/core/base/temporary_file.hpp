#pragma once

#include <atomic>
#include <filesystem>
#include <string_view>

namespace cloud2csg {

/// A new, empty file beside the one whose place it is to take, so that a rename can put it there. Removed when this
/// goes out of scope, and by remove_temporaries().
class TemporaryFile {
 public:
  /// Makes it: "<destination>.<process>.<number>.part<ending>". @throws std::system_error
  explicit TemporaryFile(const std::filesystem::path& destination, std::string_view ending = {});
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile(TemporaryFile&&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void enter_register();
  void leave_register();

  std::filesystem::path path_;
  std::atomic<const char*>* entry_ = nullptr;  ///< in the register of all that live
};

/// Removes all temporary files of the process, which must end right after. Async-signal-safe: for the handler of a
/// signal that ends the program at once. Threads that make or drop a temporary file from then on wait for that end.
void remove_temporaries() noexcept;

/// What a writer must know of the name that it is given.
struct Destination {
  std::filesystem::path path;  ///< with links followed: a rename would put a file in the place of the link
  bool is_direct;              ///< not a regular file (a pipe, /dev/stdout): to be written without a temporary
};
/// @throws Error for a folder
[[nodiscard]] Destination destination_of(const std::filesystem::path& target);

/// Throws the Error for a file that cannot be written. `reason` is an errno.
[[noreturn]] void refuse_output(const std::filesystem::path& target, std::string_view what, int reason);

}  // namespace cloud2csg
