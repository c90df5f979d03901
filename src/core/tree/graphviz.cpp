#include <fmt/format.h>

#include <string>
#include <string_view>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {
namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string label(CsgNode node, const PrimitiveSet& primitives) {
  if (node.operation() == Operation::primitive) return escaped(primitives[node.primitive()].id);
  return std::string(to_string(node.operation()));
}

}  // namespace

std::string to_graphviz(const Model& model) {
  // ordering=out keeps the first child of a difference on the left.
  std::string text = "digraph csg {\n  graph [ordering=out];\n  node [shape=box];\n";
  const CsgTree& tree = tree_of(model);
  // From the root down, so that the file reads like the picture.
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
