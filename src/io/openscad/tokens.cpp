#include "io/openscad/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/base/visible_text.hpp"
#include "io/openscad/syntax.hpp"

namespace cloud2csg::scad {
namespace {

// Not those of <cctype>, which depend on the locale and are undefined for negative characters.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

void refuse(std::string_view text, std::size_t offset, std::string expected, std::string remedy) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t begin = before.rfind('\n') + 1;  // 0 where there is none
  // Characters, not bytes: those that continue one in UTF-8 are not counted.
  const auto column = 1 + std::ranges::count_if(before.substr(begin),
                                                [](char c) { return (static_cast<unsigned char>(c) >> 6U) != 2; });
  throw Error({.file = {},
               .where = fmt::format("line {}, column {}", line, column),
               .expected = std::move(expected),
               .remedy = std::move(remedy)});
}

std::string shown(const Token& token) {
  if (token.kind == Token::Kind::end) return "the end of the file";
  return fmt::format("'{}'", visible_text(token.raw, k_longest_quote));
}

Token Tokens::next() {
  const Token token = token_;
  advance();
  return token;
}

void Tokens::skip_blanks() {
  while (place_ < text_.size()) {
    if (is_blank(text_[place_])) {
      ++place_;
    } else if (text_.substr(place_, 2) == "//") {
      place_ = std::min(text_.find('\n', place_), text_.size());
    } else if (text_.substr(place_, 2) == "/*") {
      const std::size_t end = text_.find("*/", place_ + 2);
      if (end == std::string_view::npos) refuse(text_, place_, "expected the end of this comment, */, found none");
      place_ = end + 2;
    } else {
      return;
    }
  }
}

void Tokens::take_number() {
  const char* const begin = text_.data() + place_;
  const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), token_.number);
  if (status != std::errc()) refuse(text_, place_, "expected a number that fits into double precision");
  token_.kind = Token::Kind::number;
  place_ += static_cast<std::size_t>(end - begin);
}

void Tokens::take_string() {
  token_.kind = Token::Kind::text;
  const std::size_t begin = place_++;
  while (place_ < text_.size() && text_[place_] != '"') place_ += text_[place_] == '\\' ? 2 : 1;
  if (place_ >= text_.size()) refuse(text_, begin, "expected the end of this string, found none");
  ++place_;
}

void Tokens::advance() {
  skip_blanks();
  token_ = {.kind = Token::Kind::end, .offset = place_};
  if (place_ >= text_.size()) return;
  const char c = text_[place_];
  const bool is_fraction = c == '.' && place_ + 1 < text_.size() && is_digit(text_[place_ + 1]);
  if (is_digit(c) || is_fraction) {
    take_number();
  } else if (c == '"') {
    take_string();
  } else if (begins_name(c)) {
    token_.kind = Token::Kind::name;
    while (place_ < text_.size() && (begins_name(text_[place_]) || is_digit(text_[place_]))) ++place_;
  } else if (std::string_view("()[]{},;=+-*/%#!<>?:&|.^").find(c) != std::string_view::npos) {
    token_.kind = Token::Kind::sign;
    ++place_;
  } else {
    refuse(text_, place_, "expected a word of OpenSCAD's language, found another character");
  }
  token_.raw = text_.substr(token_.offset, place_ - token_.offset);
}

}  // namespace cloud2csg::scad
