#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/clouds/file_content.hpp"

namespace cloud2csg {

/// Walks over the lines of a text file that hold something: blank lines and lines that start with `#` or `//`
/// are skipped. Keeps a reference to the content.
class TextRows {
 public:
  explicit TextRows(const FileContent& content, std::size_t first_byte = 0, std::size_t lines_before = 0);

  /// The next line without its end and surrounding blanks; absent at the end of the file.
  [[nodiscard]] std::optional<std::string_view> next_line();

  /// The numbers of the next line, separated by blanks, commas or semicolons; absent at the end of the file. Valid
  /// until the next call. @throws Error naming the line for anything that is not a number.
  [[nodiscard]] std::optional<std::span<const double>> next_row();

  /// Of the line that was read last, counted from 1.
  [[nodiscard]] FilePosition where() const { return {FilePosition::Unit::line, line_number_}; }
  /// Bytes of the file that were not yet looked at; an upper bound of what is still to come.
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }

 private:
  [[noreturn]] void fail_at(std::string_view token) const;

  const FileContent& content_;
  std::string_view rest_;
  std::size_t line_number_;
  std::vector<double> row_;
};

/// The words of a line, as separated by blanks.
[[nodiscard]] std::vector<std::string> split_words(std::string_view line);

/// A whole number that is not negative; absent when the word is anything else.
[[nodiscard]] std::optional<std::size_t> parse_count(std::string_view word);

}  // namespace cloud2csg
