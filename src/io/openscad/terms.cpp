#include "io/openscad/terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/text.hpp"

namespace cloud2csg::scad {
namespace {

// <cctype> depends on the locale and is undefined for negative characters.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
bool is_one_of(char c, std::string_view all) {
  return all.find(c) != std::string_view::npos;
}

bool is_argument_of(std::string_view call, std::string_view name) {
  constexpr std::array<std::string_view, 17> k_of_any{"size",   "center",    "r",   "r1",  "r2", "h",
                                                      "points", "faces",     "v",   "a",   "m",  "c",
                                                      "angle",  "convexity", "$fn", "$fa", "$fs"};
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> k_of_one{{{"linear_extrude", "height"},
                                                                                   {"linear_extrude", "scale"},
                                                                                   {"linear_extrude", "twist"},
                                                                                   {"linear_extrude", "slices"},
                                                                                   {"linear_extrude", "segments"},
                                                                                   {"rotate_extrude", "start"},
                                                                                   {"polygon", "paths"},
                                                                                   {"circle", "d"}}};
  return std::ranges::find(k_of_any, name) != k_of_any.end() ||
         std::ranges::find(k_of_one, std::pair(call, name)) != k_of_one.end();
}

Value number_at(std::size_t offset, double number) {
  return {.offset = offset, .number = number};
}

/// Combines two numbers, two vectors of equal length, or a vector and a factor or divisor.
Value combined(char operation, const Value& a, const Value& b) {
  Value result = a.is_list ? a : b;
  if (a.is_list && b.is_list && is_one_of(operation, "+-") && a.items.size() == b.items.size()) {
    for (std::size_t i = 0; i < a.items.size(); ++i) result.items[i] = combined(operation, a.items[i], b.items[i]);
  } else if (a.is_list && !b.is_list && is_one_of(operation, "*/")) {
    for (Value& item : result.items) item = combined(operation, item, b);
  } else if (b.is_list && !a.is_list && operation == '*') {
    for (Value& item : result.items) item = combined(operation, a, item);
  } else {
    const double left = number_of(a);
    const double right = number_of(b);
    result = number_at(a.offset, operation == '+'   ? left + right
                                 : operation == '-' ? left - right
                                 : operation == '*' ? left * right
                                                    : left / right);
  }
  return result;
}

/// `bounds`: begin, step if given, and end.
std::vector<Value> range_of(const std::vector<Value>& bounds) {
  constexpr double k_most = 1e6;
  const double begin = number_of(bounds.front());
  const double end = number_of(bounds.back());
  const double step = bounds.size() == 3 ? number_of(bounds[1]) : 1.0;
  // Rounds up as OpenSCAD does: [0 : 0.1 : 0.3] includes its end, although 3 * 0.1 is slightly more.
  const double steps = std::nextafter((end - begin) / step, std::numeric_limits<double>::max());
  // OpenSCAD reverses a falling range without a step, but has deprecated that.
  if (!(steps < k_most) || (bounds.size() == 2 && begin > end)) {
    throw Refusal(bounds[0].offset, fmt::format("expected a rising range of at most {:.0f} steps", k_most));
  }
  std::vector<Value> turns;
  for (std::size_t i = 0; static_cast<double>(i) <= steps; ++i) {
    turns.push_back(number_at(bounds[0].offset, begin + static_cast<double>(i) * step));
  }
  return turns;
}

}  // namespace

double number_of(const Value& value) {
  if (value.is_list || value.is_flag || !std::isfinite(value.number)) throw Refusal(value.offset, "expected a number");
  return value.number;
}

std::vector<double> numbers_of(const Value& value) {
  if (!value.is_list) throw Refusal(value.offset, "expected a list of numbers");
  std::vector<double> numbers(value.items.size());
  std::ranges::transform(value.items, numbers.begin(), number_of);
  return numbers;
}

Eigen::Vector3d vector_of(const Value& value, double rest) {
  const std::vector<double> found = numbers_of(value);
  if (found.empty() || found.size() > 3) throw Refusal(value.offset, "expected one to three numbers");
  Eigen::Vector3d vector = Eigen::Vector3d::Constant(rest);
  std::ranges::copy(found, vector.data());
  return vector;
}

Eigen::Vector3d vector_or_number(const Value& value, double rest) {
  return value.is_list ? vector_of(value, rest) : Eigen::Vector3d(Eigen::Vector3d::Constant(number_of(value)));
}

const Value* Arguments::find(std::string_view name, std::size_t place) const {
  for (const auto& [given, value] : values) {
    if (given.empty() ? place-- == 0 : given == name) return &value;
  }
  return nullptr;
}

const Value& Arguments::need(std::string_view name, std::size_t place) const {
  const Value* const value = find(name, place);
  if (value == nullptr) throw Refusal(call.offset, fmt::format("expected an argument '{}', found none", name));
  return *value;
}

double Arguments::number(std::string_view name, std::size_t place, double otherwise) const {
  const Value* const value = find(name, place);
  return value == nullptr ? otherwise : number_of(*value);
}

bool Arguments::flag(std::string_view name, std::size_t place) const {
  const Value* const value = find(name, place);
  if (value != nullptr && !value->is_flag) throw Refusal(value->offset, "expected true or false");
  return value != nullptr && value->number != 0;
}

void Arguments::require(bool is_right, const std::string& expected) const {
  if (!is_right) throw Refusal(call.offset, "expected " + expected);
}

Level::Level(Reader& reader_of_it) : reader(reader_of_it) {
  constexpr std::size_t k_deepest = 1000;
  if (reader.level_ == k_deepest) {
    throw Refusal(reader.peek().offset,
                  fmt::format("expected at most {} nested blocks, brackets and calls, found more", k_deepest));
  }
  ++reader.level_;
}

Reader::Reader(std::string_view text, const Variables& globals, const Variables& locals)
    : text_(text), globals_(globals), locals_(locals) {
  advance();
}

Token Reader::next() {
  const Token token = token_;
  advance();
  return token;
}

bool Reader::take(std::string_view sign) {
  const bool is_next = at(sign);
  if (is_next) advance();
  return is_next;
}

void Reader::expect(std::string_view sign) {
  if (!take(sign)) fail(fmt::format("'{}'", sign));
}

void Reader::fail(std::string_view expected) const {
  const bool is_end = token_.kind == Token::Kind::end;
  const std::string found = is_end ? "the end of the file" : '\'' + visible_text(token_.raw, k_longest_quote) + '\'';
  throw Refusal(token_.offset, fmt::format("expected {}, found {}", expected, found));
}

void Reader::go_to(std::size_t offset) {
  place_ = offset;
  advance();
}

void Reader::skip_statement() {
  for (;;) {
    if (token_.kind == Token::Kind::end) fail("the end of a statement");
    const Token token = next();
    if (token.raw == ";") return;
    if (token.raw == "(" || token.raw == "[" || token.raw == "{") skip_brackets();
    if (token.raw == "{") return;
  }
}

void Reader::skip_brackets() {
  for (std::size_t depth = 1; depth > 0;) {
    if (token_.kind == Token::Kind::end) fail("a closing bracket");
    const char first = next().raw.front();
    if (is_one_of(first, "([{")) ++depth;
    if (is_one_of(first, ")]}")) --depth;
  }
}

void Reader::advance() {
  // Nested loops reread a few words many times. Rereading this much takes seconds.
  constexpr std::size_t k_most_again = 200'000'000;
  const std::size_t before = place_;
  skip_blanks();
  token_ = {.kind = Token::Kind::end, .offset = place_};
  if (place_ < text_.size()) take_word();
  token_.raw = text_.substr(token_.offset, place_ - token_.offset);
  read_ += place_ - before;
  if (read_ > 3 * text_.size() + k_most_again) {
    throw Refusal(place_, "expected fewer or shorter loops in all");
  }
}

void Reader::skip_blanks() {
  while (place_ < text_.size()) {
    if (is_one_of(text_[place_], " \t\n\r")) {
      ++place_;
    } else if (text_.substr(place_, 2) == "//") {
      place_ = std::min(text_.find('\n', place_), text_.size());
    } else if (text_.substr(place_, 2) == "/*") {
      const std::size_t end = text_.find("*/", place_ + 2);
      if (end == std::string_view::npos) throw Refusal(place_, "expected the end of this comment, */, found none");
      place_ = end + 2;
    } else {
      return;
    }
  }
}

void Reader::take_word() {
  const char c = text_[place_];
  const bool is_fraction = c == '.' && place_ + 1 < text_.size() && is_digit(text_[place_ + 1]);
  if (is_digit(c) || is_fraction) {
    const char* const begin = text_.data() + place_;
    const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), token_.number);
    if (status != std::errc()) throw Refusal(place_, "expected a number that fits into double precision");
    token_.kind = Token::Kind::number;
    place_ += static_cast<std::size_t>(end - begin);
  } else if (begins_name(c)) {
    token_.kind = Token::Kind::name;
    while (place_ < text_.size() && (begins_name(text_[place_]) || is_digit(text_[place_]))) ++place_;
  } else if (is_one_of(c, "()[]{},;=+-*/%#!<>?:&|.^")) {
    token_.kind = Token::Kind::sign;
    ++place_;
  } else {
    throw Refusal(place_, "expected a supported character, found another");
  }
}

Value Reader::value() {
  const Level level(*this);
  return chain("+-", &Reader::product);
}

/// Operands joined by operators of equal precedence, from left to right.
Value Reader::chain(std::string_view signs, Value (Reader::*operand)()) {
  Value left = (this->*operand)();
  while (token_.kind == Token::Kind::sign && is_one_of(token_.raw.front(), signs)) {
    const char operation = next().raw.front();
    left = combined(operation, left, (this->*operand)());
  }
  return left;
}

Value Reader::factor() {
  const Token token = token_;
  bool is_negative = false;
  while (take("-")) is_negative = !is_negative;
  Value found;
  if (token_.kind == Token::Kind::number) {
    found = number_at(token_.offset, token_.number);
    advance();
  } else if (token_.kind == Token::Kind::name) {
    found = variable(next());
  } else if (take("(")) {
    found = value();
    expect(")");
  } else {
    found = list();
  }
  return is_negative ? combined('*', number_at(token.offset, -1.0), found) : found;
}

Value Reader::variable(const Token& name) const {
  if (name.raw == "true" || name.raw == "false") {
    return {.offset = name.offset, .number = name.raw == "true" ? 1.0 : 0.0, .is_flag = true};
  }
  for (const Variables* variables : {&locals_, &globals_}) {
    const auto found = variables->find(name.raw);
    if (found == variables->end()) continue;
    Value value = found->second;
    value.offset = name.offset;
    return value;
  }
  throw Refusal(name.offset, fmt::format("expected a variable with a value here, found '{}'",
                                         visible_text(name.raw, k_longest_quote)));
}

Value Reader::list() {
  Value list{.offset = token_.offset, .is_list = true};
  if (!take("[")) fail("a value");
  while (!take("]")) {
    if (!list.items.empty()) expect(",");
    if (take("]")) break;
    const Token item = token_;
    list.items.push_back(value());
    // Otherwise a few lines, each listing the previous list many times, could exhaust memory.
    if (list.items.back().is_list && item.raw != "[") throw Refusal(item.offset, "expected a number, found a list");
  }
  return list;
}

std::vector<Value> Reader::turns() {
  const Token bracket = token_;
  if (take("[") && !at("]")) {
    std::vector<Value> bounds{value()};
    while (bounds.size() < 3 && take(":")) bounds.push_back(value());
    if (bounds.size() > 1) {
      expect("]");
      return range_of(bounds);
    }
  }
  go_to(bracket.offset);
  Value found = value();
  if (!found.is_list) throw Refusal(found.offset, "expected a list or a range like [0 : 3]");
  return std::move(found.items);
}

/// The corners for path() of our files, or any value.
Value Reader::argument(const Token& call) {
  const Token first = token_;
  const bool is_path = call.raw == "polygon" && take("path") && take("(");
  if (!is_path) {
    go_to(first.offset);
    return value();
  }
  Value corners = value();
  expect(")");
  corners.offset = first.offset;
  corners.is_path = true;
  return corners;
}

Arguments Reader::arguments(const Token& call) {
  Arguments arguments{.call = call};
  expect("(");
  while (!take(")")) {
    const Token first = next();
    const bool is_named = first.kind == Token::Kind::name && take("=");
    if (!is_named) go_to(first.offset);
    if (is_named && !is_argument_of(call.raw, first.raw)) {
      throw Refusal(first.offset,
                    fmt::format("expected a known argument, found '{}'", visible_text(first.raw, k_longest_quote)));
    }
    // OpenSCAD writes this for arguments that are not given.
    if (!is_named || !take("undef")) arguments.values.emplace_back(is_named ? first.raw : "", argument(call));
    if (!at(")")) expect(",");
  }
  // Children inherit it from a call.
  for (const Variables* variables : {&locals_, &globals_}) {
    if (const auto facets = variables->find("$fn"); facets != variables->end()) arguments.values.emplace_back(*facets);
  }
  return arguments;
}

}  // namespace cloud2csg::scad
