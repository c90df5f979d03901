#include "core/tree/text.hpp"

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

bool is_name_character(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         c == ':' || byte >= 0x80U;
}

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

namespace {

std::string written_id(std::string_view id) {
  bool is_plain = !id.empty() && id != k_empty_word && id != k_full_word;
  for (const char c : id) is_plain = is_plain && is_name_character(c);
  if (is_plain) return std::string(id);
  std::string quoted = "\"";
  for (const char c : id) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// Parentheses wherever operations meet, even where precedence would do without: people misread `a | b - c & d`.
/// Chains of one operation are written flat.
bool needs_parentheses(Operation parent, bool is_second, Operation child) {
  if (arity(child) < 2) return false;
  return child != parent || (child == Operation::difference && is_second);
}

const char* symbol(Operation operation) {
  if (operation == Operation::union_of) return " | ";
  return operation == Operation::intersection ? " & " : " - ";
}

/// What is still to be written: a node, or text.
using PendingText = std::variant<std::size_t, const char*>;

void push_child(std::vector<PendingText>& pending, const CsgTree& tree, std::size_t parent, std::size_t child) {
  const Operation operation = tree.nodes()[parent].operation();
  const bool is_second = arity(operation) == 2 && child == tree.second_child(parent);
  const bool parentheses = needs_parentheses(operation, is_second, tree.nodes()[child].operation());
  if (parentheses) pending.emplace_back(")");
  pending.emplace_back(child);
  if (parentheses) pending.emplace_back("(");
}

}  // namespace

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

}  // namespace cloud2csg
