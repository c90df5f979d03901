#include <fmt/format.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

constexpr std::string_view k_empty_word = "empty";
constexpr std::string_view k_full_word = "full";

/// Whether an unquoted id may hold this byte. Every byte of UTF-8 beyond ASCII may.
bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         c == ':' || byte >= 0x80U;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string written_id(std::string_view id) {
  bool is_plain = !id.empty() && id != k_empty_word && id != k_full_word;
  for (const char c : id) is_plain = is_plain && is_name_character(c);
  if (is_plain) return std::string(id);
  return '"' + escaped(id) + '"';
}

/// Wherever operations meet, even where precedence would do: people misread `a | b - c & d`. Chains are flat.
bool needs_parentheses(Operation parent, bool is_second, Operation child) {
  if (arity(child) < 2) return false;
  return child != parent || (child == Operation::difference && is_second);
}

const char* symbol(Operation operation) {
  if (operation == Operation::union_of) return " | ";
  return operation == Operation::intersection ? " & " : " - ";
}

using PendingText = std::variant<std::size_t, const char*>;

void push_child(std::vector<PendingText>& pending, const CsgTree& tree, std::size_t parent, std::size_t child) {
  const Operation operation = tree.nodes()[parent].operation();
  const bool is_second = arity(operation) == 2 && child == tree.second_child(parent);
  const bool parentheses = needs_parentheses(operation, is_second, tree.nodes()[child].operation());
  if (parentheses) pending.emplace_back(")");
  pending.emplace_back(child);
  if (parentheses) pending.emplace_back("(");
}

struct TextToken {
  enum class Kind { name, symbol, end };
  Kind kind;
  char symbol;  ///< one of ( ) | & - ~; 0 for the other kinds
  std::string name;
  bool quoted;
  std::size_t begin;  ///< byte position in the text
};

std::string describe(const TextToken& token) {
  if (token.kind == TextToken::Kind::end) return "the end of the text";
  return token.kind == TextToken::Kind::symbol ? fmt::format("'{}'", token.symbol) : fmt::format("\"{}\"", token.name);
}

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  TextToken next() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
    const std::size_t begin = at_;
    if (at_ == text_.size()) return {TextToken::Kind::end, 0, {}, false, begin};
    const char c = text_[at_];
    if (c == '"') return {TextToken::Kind::name, 0, quoted_name(), true, begin};
    if (is_name_character(c)) {
      while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
      return {TextToken::Kind::name, 0, std::string(text_.substr(begin, at_ - begin)), false, begin};
    }
    if (std::string_view("()|&-~").find(c) == std::string_view::npos) {
      fail(begin, fmt::format("unexpected character '{}'", c), "operators are | & - ~; put unusual ids in \"quotes\"");
    }
    ++at_;
    return {TextToken::Kind::symbol, c, {}, false, begin};
  }

  [[noreturn]] void fail(std::size_t byte, std::string expected, std::string remedy) const {
    std::size_t column = 1;
    for (const char c : text_.substr(0, byte)) {
      const bool continues_character = (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
      column += continues_character ? 0 : 1;
    }
    throw Error(
        {.where = fmt::format("column {}", column), .expected = std::move(expected), .remedy = std::move(remedy)});
  }

 private:
  std::string quoted_name() {
    const std::size_t begin = at_++;
    std::string name;
    while (at_ < text_.size() && text_[at_] != '"') {
      if (text_[at_] == '\\') ++at_;
      if (at_ < text_.size()) name += text_[at_++];
    }
    if (at_ == text_.size()) fail(begin, "a quoted id without its closing quote", "add the missing \"");
    ++at_;
    return name;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// An operator or an opening parenthesis that waits for its right side.
struct Waiting {
  char symbol;
  std::size_t begin;
};

int binding(char symbol) {
  switch (symbol) {
    case '|':
    case '-':
      return 1;
    case '&':
      return 2;
    case '~':
      return 3;
    default:
      return 0;  // an opening parenthesis
  }
}

Operation operation_of(char symbol) {
  switch (symbol) {
    case '|':
      return Operation::union_of;
    case '-':
      return Operation::difference;
    case '&':
      return Operation::intersection;
    default:
      return Operation::complement;
  }
}

/// Parses by operator precedence with its own stack and writes postfix.
class Parser {
 public:
  Parser(std::string_view text, const PrimitiveSet& primitives) : lexer_(text) {
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      index_of_.emplace(primitives[i].id, static_cast<PrimitiveIndex>(i));
    }
  }

  CsgTree parse() {
    bool wants_operand = true;
    TextToken token = lexer_.next();
    for (; token.kind != TextToken::Kind::end; token = lexer_.next()) {
      wants_operand = wants_operand ? take_before_operand(token) : take_after_operand(token);
    }
    if (wants_operand) fail_without_operand(token);
    emit_down_to(1);
    if (!waiting_.empty()) {
      lexer_.fail(waiting_.back().begin, "a parenthesis that is never closed", "add the missing ')'");
    }
    return CsgTree(std::move(nodes_));
  }

 private:
  /// Returns whether an operand is still wanted.
  bool take_before_operand(const TextToken& token) {
    if (token.kind == TextToken::Kind::name) {
      nodes_.push_back(leaf(token));
      return false;
    }
    if (token.symbol != '(' && token.symbol != '~') fail_without_operand(token);
    waiting_.push_back({token.symbol, token.begin});
    return true;
  }

  bool take_after_operand(const TextToken& token) {
    const bool is_binary = token.symbol == '|' || token.symbol == '&' || token.symbol == '-';
    if (is_binary) {
      emit_down_to(binding(token.symbol));
      waiting_.push_back({token.symbol, token.begin});
      return true;
    }
    if (token.symbol != ')') {
      lexer_.fail(token.begin, fmt::format("expected an operator, found {}", describe(token)),
                  "put | & or - between two solids");
    }
    emit_down_to(1);
    if (waiting_.empty()) lexer_.fail(token.begin, "')' without its '('", "remove it or add the missing '('");
    waiting_.pop_back();
    return false;
  }

  [[noreturn]] void fail_without_operand(const TextToken& token) const {
    lexer_.fail(token.begin, fmt::format("expected a solid, found {}", describe(token)),
                "write the id of a primitive, empty, full, ~ or a formula in parentheses");
  }

  CsgNode leaf(const TextToken& token) const {
    if (!token.quoted && token.name == k_empty_word) return CsgNode::constant(Operation::empty);
    if (!token.quoted && token.name == k_full_word) return CsgNode::constant(Operation::full);
    const auto found = index_of_.find(token.name);
    if (found == index_of_.end()) {
      lexer_.fail(token.begin, fmt::format("no primitive has the id {}", describe(token)),
                  "use the id of one of the primitives");
    }
    return CsgNode::leaf(found->second);
  }

  /// Writes the waiting operators that bind at least as strongly as `weakest`, the latest first.
  void emit_down_to(int weakest) {
    while (!waiting_.empty() && binding(waiting_.back().symbol) >= weakest) {
      const Operation operation = operation_of(waiting_.back().symbol);
      std::size_t length = 1;
      for (int child = 0; child < arity(operation); ++child) length += nodes_[nodes_.size() - length].length();
      nodes_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(length)));
      waiting_.pop_back();
    }
  }

  Lexer lexer_;
  std::unordered_map<std::string, PrimitiveIndex> index_of_;  ///< the first of equal ids counts
  std::vector<Waiting> waiting_;
  std::vector<CsgNode> nodes_;
};

std::string label(CsgNode node, const PrimitiveSet& primitives) {
  if (node.operation() == Operation::primitive) return escaped(primitives[node.primitive()].id);
  return std::string(to_string(node.operation()));
}

}  // namespace

std::string_view to_string(Operation operation) {
  switch (operation) {
    case Operation::primitive:
      return "primitive";
    case Operation::empty:
      return "empty";
    case Operation::full:
      return "full";
    case Operation::complement:
      return "complement";
    case Operation::union_of:
      return "union";
    case Operation::intersection:
      return "intersection";
    case Operation::difference:
      return "difference";
  }
  return "";
}

std::string to_text(const CsgTree& tree, const PrimitiveSet& primitives) {
  std::string text;
  std::vector<PendingText> pending{tree.root()};
  while (!pending.empty()) {
    const PendingText next = pending.back();
    pending.pop_back();
    if (const auto* literal = std::get_if<const char*>(&next)) {
      text += *literal;
      continue;
    }
    const std::size_t index = std::get<std::size_t>(next);
    const CsgNode node = tree.nodes()[index];
    switch (node.operation()) {
      case Operation::primitive:
        text += written_id(primitives[node.primitive()].id);
        break;
      case Operation::empty:
        text += k_empty_word;
        break;
      case Operation::full:
        text += k_full_word;
        break;
      case Operation::complement:
        text += '~';
        push_child(pending, tree, index, tree.second_child(index));
        break;
      default:
        push_child(pending, tree, index, tree.second_child(index));
        pending.emplace_back(symbol(node.operation()));
        push_child(pending, tree, index, tree.first_child(index));
    }
  }
  return text;
}

CsgTree parse_tree(std::string_view text, const PrimitiveSet& primitives) {
  return Parser(text, primitives).parse();
}

std::string to_graphviz(const Model& model) {
  // ordering=out keeps the first child of a difference on the left.
  std::string text = "digraph csg {\n  graph [ordering=out];\n  node [shape=box];\n";
  const CsgTree& tree = tree_of(model);
  // Start at the root, so that the file reads like the picture.
  for (std::size_t i = tree.size(); i-- > 0;) {
    const CsgNode node = tree.nodes()[i];
    const char* style = node.operation() == Operation::primitive ? ", style=rounded" : "";
    text += fmt::format("  n{} [label=\"{}\"{}];\n", i, label(node, model.primitives), style);
    if (arity(node.operation()) == 2) text += fmt::format("  n{} -> n{};\n", i, tree.first_child(i));
    if (arity(node.operation()) > 0) text += fmt::format("  n{} -> n{};\n", i, tree.second_child(i));
  }
  return text + "}\n";
}

}  // namespace cloud2csg
