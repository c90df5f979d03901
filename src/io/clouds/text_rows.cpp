#include "io/clouds/text_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}
constexpr bool is_separator(char c) {
  return is_blank(c) || c == ',' || c == ';';
}

std::string_view trim(std::string_view line) {
  while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
  return line;
}

}  // namespace

TextRows::TextRows(const FileContent& content, std::size_t first_byte, std::size_t lines_before)
    : content_(content), rest_(content.bytes().substr(first_byte)), line_number_(lines_before) {
  constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
  if (first_byte == 0 && rest_.starts_with(k_byte_order_mark)) rest_.remove_prefix(k_byte_order_mark.size());
}

std::optional<std::string_view> TextRows::next_line() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    const std::string_view whole_line = rest_.substr(0, end);
    const std::string_view line = trim(whole_line.substr(0, whole_line.find('#')));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_number_;
    if (!line.empty() && !line.starts_with("//")) return line;
  }
  return std::nullopt;
}

std::optional<std::span<const double>> TextRows::next_row() {
  const std::optional<std::string_view> line = next_line();
  if (!line) return std::nullopt;
  return numbers_in(*line);
}

std::span<const double> TextRows::numbers_in(std::string_view text) {
  row_.clear();
  const char* const end = text.data() + text.size();
  const char* cursor = std::find_if_not(text.data(), end, is_blank);
  while (cursor != end) {
    const char* const token = cursor;
    if (*cursor == '+') ++cursor;  // from_chars rejects a plus sign
    double value = 0.0;
    const auto [stop, error] = std::from_chars(cursor, end, value);
    if (error != std::errc{} || (stop != end && !is_separator(*stop))) {
      fail_number({token, static_cast<std::size_t>(std::find_if(token, end, is_separator) - token)});
    }
    row_.push_back(value);
    cursor = std::find_if_not(stop, end, is_separator);
  }
  return row_;
}

void TextRows::fail_number(std::string_view word) const {
  content_.fail(where(), fmt::format("expected a number, found \"{}\"", visible_text(word, k_longest_quote)),
                "comment lines must start with #");
}

std::pair<std::string_view, std::string_view> first_word(std::string_view line) {
  const std::string_view word = line.substr(0, std::min(line.find_first_of(" \t"), line.size()));
  return {word, trim(line.substr(word.size()))};
}

std::vector<std::string> split_words(std::string_view line) {
  std::vector<std::string> words;
  const char* cursor = line.data();
  const char* const end = cursor + line.size();
  while ((cursor = std::find_if_not(cursor, end, is_blank)) != end) {
    const char* const stop = std::find_if(cursor, end, is_blank);
    words.emplace_back(cursor, stop);
    cursor = stop;
  }
  return words;
}

std::optional<std::size_t> parse_count(std::string_view word) {
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || stop != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<double> parse_number(std::string_view word) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::size_t> whole_number(double number, std::size_t most) {
  if (!(number >= 0.0) || number > static_cast<double>(most) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::size_t>(number);
}

}  // namespace cloud2csg
