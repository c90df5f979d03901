#pragma once

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

/// Files that appear whole or not at all: temporary files, files that replace another, and sets of files.
namespace cloud2csg {

/// A new, empty file beside its destination, for a rename. The destructor and remove_temporaries() remove it.
class TemporaryFile {
 public:
  /// Creates "<destination>.<process>.<number>.part<ending>". @throws std::system_error
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
  std::atomic<const char*>* entry_ = nullptr;  ///< in the register of all temporary files
};

/// Removes all temporary files of the process, which must end right after. Async-signal-safe: for the handler of a
/// signal that ends the program. Threads that then make or drop a temporary file wait for the program to end.
void remove_temporaries() noexcept;

struct Destination {
  std::filesystem::path path;  ///< with links followed: a rename would replace the link
  bool is_direct;              ///< not a regular file (a pipe, /dev/stdout): written without a temporary
};
/// @throws Error for a folder
[[nodiscard]] Destination destination_of(const std::filesystem::path& target);

/// Throws the Error for a file that cannot be written. `reason` is an errno.
[[noreturn]] void refuse_output(const std::filesystem::path& target, std::string_view what, int reason);

/// A file in the system's folder for temporary files. The destructor removes it.
class ScratchFile {
 public:
  /// The name of the file ends in `ending`. @throws Error
  explicit ScratchFile(std::string_view ending = {});
  [[nodiscard]] const std::filesystem::path& path() const { return file_->path(); }

 private:
  std::optional<TemporaryFile> file_ = {};
};

/// A file that appears under its name only when it is whole: commit() flushes and renames a temporary beside it.
/// Without commit() an older file of that name stays. Follows symbolic links. Writes a target that is no regular file
/// (a pipe, /dev/stdout) directly. All functions throw Error naming the file and the system's reason (disk full, no
/// such folder...).
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
  std::filesystem::path place_;                  ///< `target` with links followed
  std::optional<TemporaryFile> temporary_ = {};  ///< absent when the target is written directly
  std::FILE* file_ = nullptr;
};

/// Writes the file whole or not at all. @throws Error
void write_text_file(const std::filesystem::path& file, std::string_view text);

/// @throws Error when the file is missing or cannot be read.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// Several files that appear together or not at all: commit() renames all temporaries. Without it older files stay.
/// Writes a target that is no regular file (a pipe, /dev/stdout) directly. All functions throw Error naming the file.
class OutputSet {
 public:
  OutputSet();
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;
  OutputSet(OutputSet&&) = delete;
  OutputSet& operator=(OutputSet&&) = delete;

  /// Calls write(path) with a temporary path that has the ending of `target`. It must write a whole file. An Error that
  /// names this path is passed on with the name of the target.
  void add(const std::filesystem::path& target, const std::function<void(const std::filesystem::path&)>& write);

  /// Takes back the files already in place when one cannot be put in place.
  void commit();

 private:
  struct Entry;
  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace cloud2csg
