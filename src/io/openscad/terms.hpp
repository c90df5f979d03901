#pragma once

#include <Eigen/Core>
#include <exception>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The supported part of OpenSCAD's language; see docs/openscad.md.
namespace cloud2csg::scad {

/// What was expected, and where in the text. Callers outside this folder receive an Error instead.
struct Refusal : std::exception {
  Refusal(std::size_t at, std::string what_was_expected) : offset(at), expected(std::move(what_was_expected)) {}

  std::size_t offset;
  std::string expected;
};

struct Token {
  enum class Kind { number, name, sign, end };
  Kind kind = Kind::end;
  std::size_t offset = 0;
  std::string_view raw = {};
  double number = 0;
};

/// A number, a list, or true or false.
struct Value {
  std::size_t offset = 0;  ///< start of its term
  double number = 0;
  bool is_flag = false;
  bool is_list = false;
  bool is_path = false;  ///< corners as path() of our files takes them, given to polygon()
  std::vector<Value> items = {};
};

using Variables = std::map<std::string_view, Value>;

// Throw Refusal for any other value.
[[nodiscard]] double number_of(const Value& value);
[[nodiscard]] std::vector<double> numbers_of(const Value& value);
/// A list of one to three numbers; `rest` replaces missing ones.
[[nodiscard]] Eigen::Vector3d vector_of(const Value& value, double rest = 0);
/// The same, or one number for all three.
[[nodiscard]] Eigen::Vector3d vector_or_number(const Value& value, double rest);

/// The arguments of a call, by name or position (0 is the first). An argument with a position may omit its name.
struct Arguments {
  Token call;
  std::vector<std::pair<std::string_view, Value>> values = {};

  static constexpr std::size_t k_by_name = std::numeric_limits<std::size_t>::max();
  [[nodiscard]] const Value* find(std::string_view name, std::size_t place) const;
  /// @throws Refusal if missing
  [[nodiscard]] const Value& need(std::string_view name, std::size_t place) const;
  [[nodiscard]] double number(std::string_view name, std::size_t place, double otherwise) const;
  [[nodiscard]] bool flag(std::string_view name, std::size_t place) const;
  void require(bool is_right, const std::string& expected) const;
};

/// Reads words (without blanks and comments) and terms: numbers, operators, brackets, lists, variables. Throws Refusal.
class Reader {
 public:
  /// All arguments must outlive this.
  Reader(std::string_view text, const Variables& globals, const Variables& locals);

  [[nodiscard]] const Token& peek() const { return token_; }
  [[nodiscard]] bool at(std::string_view sign) const { return token_.raw == sign; }
  Token next();                        ///< advances
  bool take(std::string_view sign);    ///< advances if `sign` comes next
  void expect(std::string_view sign);  ///< advances, or fails
  [[noreturn]] void fail(std::string_view expected) const;
  /// Jumps to the word at `offset`.
  void go_to(std::size_t offset);
  /// Skips a statement up to its semicolon or closing brace.
  void skip_statement();
  /// Skips to the end of the bracket taken last.
  void skip_brackets();

  [[nodiscard]] Value value();
  /// The values of a loop variable: the items of a list, or a range like [0 : 3] or [0 : 0.5 : 3].
  [[nodiscard]] std::vector<Value> turns();
  /// The arguments of a call with their brackets, plus $fn if a variable sets it.
  [[nodiscard]] Arguments arguments(const Token& call);

 private:
  friend struct Level;

  void advance();
  void skip_blanks();
  void take_word();
  Value chain(std::string_view signs, Value (Reader::*operand)());
  Value product() { return chain("*/", &Reader::factor); }
  Value factor();
  Value argument(const Token& call);
  Value list();
  [[nodiscard]] Value variable(const Token& name) const;

  std::string_view text_;
  const Variables& globals_;
  const Variables& locals_;
  std::size_t place_ = 0;
  std::size_t read_ = 0;  ///< bytes read so far, repeats included
  std::size_t level_ = 0;
  Token token_ = {};
};

/// Held during each nested construct; limits stack depth for any text.
struct Level {
  explicit Level(Reader& reader_of_it);
  ~Level() { --reader.level_; }
  Level(const Level&) = delete;
  Level& operator=(const Level&) = delete;
  Reader& reader;
};

}  // namespace cloud2csg::scad
