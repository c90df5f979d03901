#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cloud2csg::scad {

struct Token {
  enum class Kind { number, text, name, sign, end };
  Kind kind = Kind::end;
  std::size_t offset = 0;
  std::string_view raw = {};  ///< as it stands in the file
  double number = 0;
};

/// One word after the other, without blanks and comments.
class Tokens {
 public:
  /// `text` must outlive this. @throws Error as next()
  explicit Tokens(std::string_view text) : text_(text) { advance(); }

  /// The word that comes next, and moves on. @throws Error for what no word begins with, an open string or comment
  Token next();
  [[nodiscard]] const Token& peek() const { return token_; }
  [[nodiscard]] bool at(std::string_view sign) const { return token_.kind == Token::Kind::sign && token_.raw == sign; }
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  void advance();
  void skip_blanks();
  void take_number();
  void take_string();

  std::string_view text_;
  std::size_t place_ = 0;
  Token token_ = {};
};

/// For messages: the word in quotes, shortened.
[[nodiscard]] std::string shown(const Token& token);

}  // namespace cloud2csg::scad
