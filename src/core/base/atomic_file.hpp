#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string_view>

#include "core/base/temporary_file.hpp"

namespace cloud2csg {

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

}  // namespace cloud2csg
