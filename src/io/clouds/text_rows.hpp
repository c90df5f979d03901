#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/clouds/file_content.hpp"

namespace cloud2csg {

/// The lines of a text without blanks and comments (from `#` on, or lines that begin with `//`). `content` must
/// outlive this.
class TextRows {
 public:
  explicit TextRows(const FileContent& content, std::size_t first_byte = 0, std::size_t lines_before = 0);

  /// The next line, trimmed; absent at the end of the file.
  [[nodiscard]] std::optional<std::string_view> next_line();

  /// The next line's numbers, separated by blanks, commas or semicolons; absent at the end. Valid until the next call.
  /// @throws Error naming the line for anything that is not a number.
  [[nodiscard]] std::optional<std::span<const double>> next_row();

  /// The numbers in a part of the current line; may be empty.
  [[nodiscard]] std::span<const double> numbers_in(std::string_view text);
  /// @throws Error: expected a number, found `word` in the current line.
  [[noreturn]] void fail_number(std::string_view word) const;

  /// The current line, counted from 1.
  [[nodiscard]] FilePosition where() const { return {FilePosition::Unit::line, line_number_}; }
  /// Number of unread bytes: an upper bound on the remaining text.
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }

 private:
  const FileContent& content_;
  std::string_view rest_;
  std::size_t line_number_;
  std::vector<double> row_;
};

[[nodiscard]] std::pair<std::string_view, std::string_view> first_word(std::string_view line);
[[nodiscard]] std::vector<std::string> split_words(std::string_view line);

/// A non-negative whole number; absent for any other word.
[[nodiscard]] std::optional<std::size_t> parse_count(std::string_view word);
/// A finite number; absent for any other word.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);
/// Converts a count read as a double; absent unless it is a whole number from 0 to `most`.
[[nodiscard]] std::optional<std::size_t> whole_number(double number, std::size_t most);

}  // namespace cloud2csg
