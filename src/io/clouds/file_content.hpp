#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// A place in a file, for messages. Lines count from 1, all other units from 0.
struct FilePosition {
  enum class Unit { line, byte, vertex, triangle };
  Unit unit;
  std::size_t number;
};

constexpr const char* k_copy_again = "the file is cut off or damaged: copy or export it again";

class FileContent {
 public:
  /// Reads the file, or its first `limit` bytes. O(n). @throws Error for a directory or an unreadable file; Cancelled.
  explicit FileContent(const std::filesystem::path& file, const RunContext& run = {},
                       std::size_t limit = std::numeric_limits<std::size_t>::max());

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view bytes() const { return {bytes_.get(), size_}; }

  [[noreturn]] void fail(FilePosition where, std::string expected, std::string remedy = {}) const;
  [[noreturn]] void fail(std::string expected, std::string remedy = {}) const;
  /// @throws Error: the file announces `announced` things but holds only `found`.
  [[noreturn]] void fail_truncated(FilePosition where, std::size_t announced, std::size_t found,
                                   const char* things = "points") const;

 private:
  void grow(std::size_t capacity);

  std::string name_;
  std::unique_ptr<char[]> bytes_;  // NOLINT(modernize-avoid-c-arrays): a vector would write every byte first
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace cloud2csg
