#include "io/model/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

// Each level of the tree is an object within a list; the rest of a model is far flatter than the spare levels.
constexpr std::size_t k_max_nesting = 2 * k_max_tree_depth + 16;
constexpr std::size_t k_longest_reason = 80;

std::string place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

/// What is wrong in the library's words, without its head "[json.exception...] parse error at line 1, column 2: syntax
/// error while parsing value - " and, where that is no text to show, its tail "; last read: '...'".
std::string reason_of(const json::exception& exception) {
  std::string reason = exception.what();
  for (const char* end_of_head : {": ", " - "}) {
    if (const std::size_t head = reason.find(end_of_head); head != std::string::npos) reason.erase(0, head + 2);
  }
  const bool is_plain = std::all_of(reason.begin(), reason.end(), [](char c) { return c >= ' ' && c <= '~'; });
  const std::size_t tail = reason.find("; last read: ");
  if (tail != std::string::npos && (!is_plain || reason.size() > k_longest_reason)) reason.erase(tail);
  return reason.substr(reason.find_first_not_of(' '), k_longest_reason);
}

[[noreturn]] void refuse_text(std::string_view text, std::size_t byte, const std::string& reason) {
  throw Error({.where = place_of(text, byte),
               .expected = fmt::format("expected JSON, found an error in it: {}", reason),
               .remedy = "correct the text there"});
}

/// Goes through a text before it becomes values: whether it is JSON, and what JSON as such allows: numbers that no
/// double holds, fields given twice, bottomless nesting. (The library's own callback while parsing takes a time that is
/// quadratic in the length of lists.)
class ParseGuard : public nlohmann::json_sax<json> {
 public:
  explicit ParseGuard(std::string_view text) : text_(text) {}

  bool null() override { return finish_value(); }
  bool boolean(bool /*value*/) override { return finish_value(); }
  bool number_integer(number_integer_t /*value*/) override { return finish_value(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return finish_value(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return finish_value(); }
  bool string(string_t& /*value*/) override { return finish_value(); }
  bool binary(binary_t& /*value*/) override { return finish_value(); }
  bool start_object(std::size_t /*size*/) override { return open(false); }
  bool start_array(std::size_t /*size*/) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override { return add_field(name); }
  bool parse_error(std::size_t byte, const std::string& last_word, const json::exception& error) override {
    constexpr int k_no_double = 406;
    if (error.id != k_no_double) refuse_text(text_, byte, reason_of(error));
    throw Error({.where = path(),
                 .expected = fmt::format("expected a number that fits a double, found {}",
                                         visible_text(last_word, k_longest_quote)),
                 .remedy = "numbers go up to about 1.8e308"});
  }

 private:
  /// JSON pointer of the value that is being read.
  [[nodiscard]] std::string path() const {
    json::json_pointer pointer;
    for (const Level& level : levels_) {
      if (level.is_list) {
        pointer.push_back(std::to_string(level.index));
      } else if (!level.field.empty()) {
        pointer.push_back(level.field);
      }
    }
    return pointer.to_string();
  }

  /// An object or a list that has not ended.
  struct Level {
    bool is_list;
    std::size_t index = 0;   ///< of the value in a list
    std::string field = {};  ///< of the value in an object
    std::set<std::string> fields = {};
  };

  bool open(bool is_list) {
    if (levels_.size() >= k_max_nesting) {
      throw Error({.where = levels_.front().is_list ? "" : "/" + levels_.front().field,
                   .expected = fmt::format("nested too deeply: a tree may have {} levels", k_max_tree_depth),
                   .remedy = "write chains of the same union as one node with many children"});
    }
    levels_.push_back({.is_list = is_list});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return finish_value();
  }

  bool finish_value() {
    if (!levels_.empty() && levels_.back().is_list) ++levels_.back().index;
    return true;
  }

  bool add_field(const std::string& name) {
    Level& object = levels_.back();
    object.field = name;
    if (object.fields.insert(name).second) return true;
    throw Error({.where = path(),
                 .expected = "expected each field of an object once, found this one twice",
                 .remedy = "leave one of the two"});
  }

  std::string_view text_;
  std::vector<Level> levels_ = {};
};

}  // namespace

json parse_json(std::string_view text) {
  // To the library the text ends there.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    refuse_text(text, nul + 1, "a byte of value 0");
  }
  ParseGuard guard(text);
  json::sax_parse(text, &guard);
  return json::parse(text);
}

}  // namespace cloud2csg
