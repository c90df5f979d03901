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

/// Walks over the lines of a text file that hold something: what follows on `#`, lines that start with `//` and blank
/// ones are skipped. Keeps a reference to the content.
class TextRows {
 public:
  explicit TextRows(const FileContent& content, std::size_t first_byte = 0, std::size_t lines_before = 0);

  /// The next line without its end and surrounding blanks; absent at the end of the file.
  [[nodiscard]] std::optional<std::string_view> next_line();

  /// The numbers of the next line, separated by blanks, commas or semicolons; absent at the end of the file. Valid
  /// until the next call. @throws Error naming the line for anything that is not a number.
  [[nodiscard]] std::optional<std::span<const double>> next_row();

  /// The same of a part of the line that was read last; may be empty.
  [[nodiscard]] std::span<const double> numbers_in(std::string_view text);
  /// @throws Error: expected a number, found this word in the line that was read last.
  [[noreturn]] void fail_number(std::string_view word) const;

  /// Of the line that was read last, counted from 1.
  [[nodiscard]] FilePosition where() const { return {FilePosition::Unit::line, line_number_}; }
  /// Bytes of the file that were not yet looked at; an upper bound of what is still to come.
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }

 private:
  const FileContent& content_;
  std::string_view rest_;
  std::size_t line_number_;
  std::vector<double> row_;
};

/// The first word of a line, and what follows on it.
[[nodiscard]] std::pair<std::string_view, std::string_view> first_word(std::string_view line);
/// The words of a line, as separated by blanks.
[[nodiscard]] std::vector<std::string> split_words(std::string_view line);

/// A whole number that is not negative; absent when the word is anything else.
[[nodiscard]] std::optional<std::size_t> parse_count(std::string_view word);
/// A finite number; absent when the word is anything else.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);
/// A number of things as a file gives it; absent when it is not a whole number up to `most`.
[[nodiscard]] std::optional<std::size_t> whole_number(double number, std::size_t most);

}  // namespace cloud2csg
