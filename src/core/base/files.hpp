#pragma once

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

/// Files that appear whole or not at all: temporary ones, one that replaces another, several that belong together.
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

/// A file in the system's folder for temporary files, as long as this lives.
class ScratchFile {
 public:
  /// Its name has that ending. @throws Error
  explicit ScratchFile(std::string_view ending = {});
  [[nodiscard]] const std::filesystem::path& path() const { return file_->path(); }

 private:
  std::optional<TemporaryFile> file_ = {};
};

/// A file that appears under its name only when it is whole: writes go to a temporary beside it, commit() flushes
/// and renames; without commit() the temporary is removed and an older file of that name stays. A symbolic link is
/// followed; what is no regular file (a pipe, /dev/stdout) is written directly.
/// All functions throw Error naming the file, with the system's reason (disk full, no such folder...).
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  AtomicFile(AtomicFile&&) = delete;
  AtomicFile& operator=(AtomicFile&&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path target_;                 ///< as the caller names it, for messages
  std::filesystem::path place_;                  ///< the same with links followed
  std::optional<TemporaryFile> temporary_ = {};  ///< absent when the target is written directly
  std::FILE* file_ = nullptr;
};

/// The whole of `text` as a file, or none of it. @throws Error
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// The whole of a file. @throws Error when it is missing or cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// Several files that appear together under their names: all or none. Each is written beside its place; commit()
/// renames them all. Without it nothing appears, and older files of these names stay. What is no regular file (a pipe,
/// /dev/stdout) is written directly. All functions throw Error naming the file.
class OutputSet {
 public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Calls write(path), which is to write a whole file: not `target` itself, but with the same ending. An Error of it
  /// that names this path is passed on with the name of the target.
  void add(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

  /// When one file cannot be put in place, those before it are taken back.
  void commit();

 private:
  struct Entry;
  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace cloud2csg
