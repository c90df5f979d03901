#include "io/model/tree_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "cloud2csg/error.hpp"
#include "io/model/schema_validator.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

struct Kind {
  const char* definition;  ///< name in the schema
  Operation operation;
};
constexpr std::array k_kinds = {Kind{"n_ary", Operation::union_of},        Kind{"n_ary", Operation::intersection},
                                Kind{"difference", Operation::difference}, Kind{"complement", Operation::complement},
                                Kind{"constant", Operation::empty},        Kind{"constant", Operation::full}};
constexpr Kind k_leaf = {"leaf", Operation::primitive};

struct OpenNode {
  const json* children;
  Operation operation;
  std::size_t children_done = 0;
  std::size_t first_node;  ///< in the postfix array
};

class TreeReader {
 public:
  TreeReader(const std::map<std::string, PrimitiveIndex, std::less<>>& index_of_id, const NodeCheck& check)
      : index_of_id_(index_of_id), check_(check) {}

  CsgTree read(const json& root) {
    enter(root);
    while (!open_.empty()) {
      OpenNode& node = open_.back();
      if (node.children_done < node.children->size()) {
        enter((*node.children)[node.children_done]);
      } else {
        if (node.operation == Operation::complement) emit_inner(node);
        open_.pop_back();
        finish_child();
      }
    }
    return CsgTree(postfix_);
  }

 private:
  /// Reads a leaf whole, or opens an inner node.
  void enter(const json& node) {
    const Kind kind = kind_of(node);
    check(kind, node);
    if (arity(kind.operation) > 0) {
      open_.push_back({.children = &node["children"], .operation = kind.operation, .first_node = postfix_.size()});
      return;
    }
    postfix_.push_back(kind.operation == Operation::primitive ? leaf(node) : CsgNode::constant(kind.operation));
    finish_child();
  }

  void check(const Kind& kind, const json& node) const {
    try {
      check_(kind.definition, node);
    } catch (const Error& error) {
      Error::Parts parts = error.parts();
      parts.where = path() + parts.where;
      throw Error(parts);
    }
  }

  /// Combines the latest child with its preceding siblings.
  void finish_child() {
    if (open_.empty()) return;
    OpenNode& parent = open_.back();
    if (++parent.children_done > 1) emit_inner(parent);
  }

  void emit_inner(const OpenNode& node) {
    const auto length = static_cast<std::uint32_t>(postfix_.size() - node.first_node + 1);
    postfix_.push_back(CsgNode::inner(node.operation, length));
  }

  [[nodiscard]] CsgNode leaf(const json& node) const {
    const auto found = index_of_id_.find(node["primitive"].get_ref<const std::string&>());
    if (found == index_of_id_.end()) {
      throw Error({.where = path() + "/primitive",
                   .expected = fmt::format("expected the id of a primitive, found {}", brief(node["primitive"])),
                   .remedy = "add the primitive or correct the id"});
    }
    return CsgNode::leaf(found->second);
  }

  [[nodiscard]] Kind kind_of(const json& node) const {
    if (node.is_object() && node.contains("primitive")) return k_leaf;
    const json op = node.is_object() ? node.value("op", json()) : json();
    for (const Kind& kind : k_kinds) {
      if (op == to_string(kind.operation)) return kind;
    }
    if (node.is_object() && node.contains("op")) {
      throw Error(
          {.where = path() + "/op",
           .expected = fmt::format("expected one of union, intersection, difference, complement, empty, full, found {}",
                                   brief(op))});
    }
    throw Error({.where = path(),
                 .expected = fmt::format(R"(expected an object with a field "primitive" or "op", found {})",
                                         node.is_object() ? "neither" : brief(node))});
  }

  [[nodiscard]] std::string path() const {
    std::string path = "/tree";
    for (const OpenNode& node : open_) path += fmt::format("/children/{}", node.children_done);
    return path;
  }

  const std::map<std::string, PrimitiveIndex, std::less<>>& index_of_id_;
  const NodeCheck& check_;
  std::vector<OpenNode> open_ = {};
  std::vector<CsgNode> postfix_ = {};
};

}  // namespace

CsgTree read_tree(const json& root, const std::map<std::string, PrimitiveIndex, std::less<>>& index_of_id,
                  const NodeCheck& check) {
  return TreeReader(index_of_id, check).read(root);
}

}  // namespace cloud2csg
