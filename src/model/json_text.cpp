#include "model/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

// Each level of the tree is an object within a list; the rest of a model is far flatter than the spare levels.
constexpr int k_max_nesting = 2 * k_max_tree_depth + 16;
constexpr std::size_t k_longest_reason = 200;

/// Watches the parser for what JSON as such allows: fields given twice, bottomless nesting.
class ParseGuard {
 public:
  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    if (event == json::parse_event_t::object_start) open_object(depth);
    if (event == json::parse_event_t::object_end) open_objects_.pop_back();
    if (event == json::parse_event_t::key) add_field(parsed.get<std::string>());
    return true;
  }

 private:
  void open_object(int depth) {
    if (depth > k_max_nesting) {
      throw Error({.file = {},
                   .where = "/tree",
                   .expected = fmt::format("expected at most {} levels", k_max_tree_depth),
                   .remedy = "write chains of the same union as one node with many children"});
    }
    open_objects_.emplace_back();
  }

  void add_field(const std::string& name) {
    if (open_objects_.back().insert(name).second) return;
    throw Error({.file = {},
                 .where = fmt::format("field \"{}\"", name),
                 .expected = "expected each field of an object once, found it twice",
                 .remedy = {}});
  }

  std::vector<std::set<std::string>> open_objects_;
};

std::string place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

/// What is wrong, without the library's own head "[json.exception...] parse error at line 1, column 2: ".
std::string reason_of(const json::exception& exception) {
  std::string reason = exception.what();
  if (const std::size_t head = reason.find(": "); head != std::string::npos) reason.erase(0, head + 2);
  if (reason.size() > k_longest_reason) reason = reason.substr(0, k_longest_reason) + "...";
  return reason;
}

}  // namespace

json parse_json(std::string_view text) {
  ParseGuard guard;
  try {
    return json::parse(text, std::ref(guard));
  } catch (const json::parse_error& error) {
    throw Error({.file = {}, .where = place_of(text, error.byte), .expected = reason_of(error), .remedy = {}});
  } catch (const json::exception& error) {
    throw Error({.file = {}, .where = {}, .expected = error.what(), .remedy = "numbers must fit a double"});
  }
}

}  // namespace cloud2csg
