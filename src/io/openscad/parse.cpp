#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "io/openscad/syntax.hpp"
#include "io/openscad/tokens.hpp"

namespace cloud2csg::scad {
namespace {

constexpr std::array<std::string_view, 9> k_beyond = {"function", "use",  "include", "if",  "let",
                                                      "assert",   "echo", "assign",  "each"};

/// One function a rule of the grammar.
class Parser {
 public:
  explicit Parser(std::string_view text) : tokens_(text) {}

  std::vector<Statement> file() {
    std::vector<Statement> statements;
    while (tokens_.peek().kind != Token::Kind::end) add_statement(statements);
    return statements;
  }

 private:
  /// Held while something is inside of something.
  class Level {
   public:
    explicit Level(Parser& parser) : parser_(parser) {
      if (++parser_.level_ > k_deepest) {
        refuse(parser_.tokens_.text(), parser_.tokens_.peek().offset,
               fmt::format("expected at most {} levels of nesting, found more", k_deepest));
      }
    }
    ~Level() { --parser_.level_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    Level(Level&&) = delete;
    Level& operator=(Level&&) = delete;

   private:
    Parser& parser_;
  };

  [[noreturn]] void fail(const Token& at, std::string_view expected, const std::string& remedy = {}) const {
    refuse(tokens_.text(), at.offset, fmt::format("expected {}, found {}", expected, shown(at)), remedy);
  }

  Token expect(std::string_view sign) {
    if (!tokens_.at(sign)) fail(tokens_.peek(), fmt::format("'{}'", sign));
    return tokens_.next();
  }

  bool take(std::string_view sign) {
    if (!tokens_.at(sign)) return false;
    tokens_.next();
    return true;
  }

  void add_statement(std::vector<Statement>& statements) {
    if (take(";")) return;
    statements.push_back(statement());
  }

  Statement statement() {
    const Level level(*this);
    const Token first = tokens_.peek();
    if (take("{")) {
      Statement block{.kind = Statement::Kind::block, .offset = first.offset};
      while (!take("}")) {
        if (tokens_.peek().kind == Token::Kind::end) fail(tokens_.peek(), "'}'");
        add_statement(block.children);
      }
      return block;
    }
    if (tokens_.at("*") || tokens_.at("%")) {
      tokens_.next();
      Statement hidden = statement();
      hidden.is_shown = false;
      return hidden;
    }
    if (take("#")) return statement();
    if (first.kind != Token::Kind::name) {
      fail(first, "a solid, an operation or an assignment", tokens_.at("!") ? "remove the '!'" : "");
    }
    return named_statement();
  }

  Statement named_statement() {
    const Token name = tokens_.next();
    if (std::ranges::find(k_beyond, name.raw) != k_beyond.end()) fail(name, "a solid or an operation", k_flatten);
    if (name.raw == "module") return module_definition();
    Statement statement{.kind = Statement::Kind::assignment, .offset = name.offset, .name = std::string(name.raw)};
    if (take("=")) {
      statement.arguments.push_back({.name = {}, .value = term()});
      expect(";");
      return statement;
    }
    statement.kind = Statement::Kind::call;
    if (!tokens_.at("(")) fail(tokens_.peek(), fmt::format("'(' or '=' after '{}'", name.raw));
    statement.arguments = arguments();
    add_children(statement);
    return statement;
  }

  /// What follows on a call: nothing, one statement, or a block of them.
  void add_children(Statement& parent) {
    if (take(";")) return;
    Statement child = statement();
    if (child.kind == Statement::Kind::block && child.is_shown) {
      parent.children = std::move(child.children);
    } else {
      parent.children.push_back(std::move(child));
    }
  }

  Statement module_definition() {
    const Token name = tokens_.next();
    if (name.kind != Token::Kind::name) fail(name, "the name of a module");
    Statement definition{
        .kind = Statement::Kind::module_definition, .offset = name.offset, .name = std::string(name.raw)};
    expect("(");
    if (!tokens_.at(")")) fail(tokens_.peek(), "a module without parameters", k_flatten);
    tokens_.next();
    add_children(definition);
    return definition;
  }

  std::vector<Argument> arguments() {
    expect("(");
    std::vector<Argument> arguments;
    while (!take(")")) {
      if (!arguments.empty()) {
        if (!tokens_.at(",")) fail(tokens_.peek(), "',' or ')'");
        tokens_.next();
        if (take(")")) break;
      }
      Argument argument{.name = {}, .value = term()};
      if (argument.value.kind == Term::Kind::name && take("=")) {
        argument.name = argument.value.text;
        argument.value = term();
      }
      arguments.push_back(std::move(argument));
    }
    return arguments;
  }

  Term term() {
    return chain("+-", [this] { return chain("*/%", [this] { return signed_term(); }); });
  }

  /// Operands with operators of the same rank between them: one level, however long, so that a sum of many needs no
  /// more of the stack than a sum of two.
  template <class Operand>
  Term chain(std::string_view operators, const Operand& operand) {
    const Level level(*this);
    Term first = operand();
    Term chain{.kind = Term::Kind::chain, .offset = first.offset};
    while (tokens_.peek().kind == Token::Kind::sign && operators.find(tokens_.peek().raw) != std::string_view::npos) {
      chain.text += tokens_.next().raw;
      chain.operands.push_back(operand());
    }
    if (chain.operands.empty()) return first;
    chain.operands.insert(chain.operands.begin(), std::move(first));
    return chain;
  }

  Term signed_term() {
    const Level level(*this);
    const Token sign = tokens_.peek();
    if (take("+")) return signed_term();
    if (take("-")) return {.kind = Term::Kind::negation, .offset = sign.offset, .operands = {signed_term()}};
    if (take("!")) return {.kind = Term::Kind::denial, .offset = sign.offset, .operands = {signed_term()}};
    Term value = simple_term();
    for (const char* sign_beyond : {"[", ".", "(", "?", "<", ">", "&", "|", "^"}) {
      if (tokens_.at(sign_beyond)) fail(tokens_.peek(), "numbers with + - * / %", k_flatten);
    }
    return value;
  }

  Term simple_term() {
    const Token token = tokens_.next();
    Term term{.kind = Term::Kind::number, .offset = token.offset, .number = token.number};
    if (token.kind == Token::Kind::number) return term;
    if (token.kind == Token::Kind::text) {
      term.kind = Term::Kind::text;
      return term;
    }
    if (token.kind == Token::Kind::name) return word(token);
    if (token.raw == "(") {
      term = this->term();
      expect(")");
      return term;
    }
    if (token.raw != "[") fail(token, "a value");
    return list_or_range(token);
  }

  /// What follows on the bracket.
  Term list_or_range(const Token& bracket) {
    Term list{.kind = Term::Kind::list, .offset = bracket.offset};
    while (!take("]")) {
      if (!list.operands.empty()) {
        if (list.operands.size() == 1 && tokens_.at(":")) return range(std::move(list));
        if (!tokens_.at(",")) fail(tokens_.peek(), "',' or ']'");
        tokens_.next();
        if (take("]")) break;
      }
      list.operands.push_back(term());
    }
    return list;
  }

  /// What follows on its first number.
  Term range(Term first) {
    Term range = std::move(first);
    range.kind = Term::Kind::range;
    while (range.operands.size() < 3 && take(":")) range.operands.push_back(term());
    expect("]");
    return range;
  }

  static Term word(const Token& token) {
    if (token.raw == "true" || token.raw == "false") {
      return {.kind = Term::Kind::boolean, .offset = token.offset, .number = token.raw == "true" ? 1.0 : 0.0};
    }
    if (token.raw == "undef") return {.kind = Term::Kind::undefined, .offset = token.offset};
    return {.kind = Term::Kind::name, .offset = token.offset, .text = std::string(token.raw)};
  }

  Tokens tokens_;
  std::size_t level_ = 0;
};

}  // namespace

std::vector<Statement> parse(std::string_view text) {
  return Parser(text).file();
}

}  // namespace cloud2csg::scad
