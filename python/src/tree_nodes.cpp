#include "tree_nodes.hpp"

#include <fmt/format.h>

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"

namespace cloud2csg::python {
namespace {

namespace py = pybind11;

using IndexOfId = std::unordered_map<std::string, PrimitiveIndex>;

CsgNode leaf(const std::string& id, const IndexOfId& index_of_id) {
  const auto found = index_of_id.find(id);
  if (found != index_of_id.end()) return CsgNode::leaf(found->second);
  throw Error({.where = "tree",
               .expected = fmt::format(R"(expected the id of a primitive, found "{}")", id),
               .remedy = "add the primitive or correct the id"});
}

Operation operation_named(const std::string& name) {
  for (const Operation operation : {Operation::primitive, Operation::empty, Operation::full, Operation::complement,
                                    Operation::union_of, Operation::intersection}) {
    if (to_string(operation) == name) return operation;
  }
  return Operation::difference;
}

/// Builds a tree from (operation, id) of each node, children first.
CsgTree read_postfix(const py::list& nodes, const PrimitiveSet& primitives) {
  IndexOfId index_of_id;
  for (PrimitiveIndex i = 0; i < primitives.size(); ++i) index_of_id.emplace(primitives[i].id, i);
  std::vector<CsgNode> postfix;
  postfix.reserve(nodes.size());
  std::vector<std::uint32_t> lengths;  // subtrees without a parent so far
  for (const py::handle& node : nodes) {
    const auto [name, id] = node.cast<std::pair<std::string, std::string>>();
    const Operation operation = operation_named(name);
    std::uint32_t length = 1;
    for (int child = arity(operation); child > 0; --child) {
      length += lengths.back();
      lengths.pop_back();
    }
    lengths.push_back(length);
    if (operation == Operation::primitive) {
      postfix.push_back(leaf(id, index_of_id));
    } else {
      postfix.push_back(CsgNode::inner(operation, length));
    }
  }
  return CsgTree(std::move(postfix));
}

}  // namespace

py::object to_nodes(const CsgTree& tree, const PrimitiveSet& primitives) {
  py::list nodes;
  for (const CsgNode node : tree.nodes()) {
    const bool is_primitive = node.operation() == Operation::primitive;
    nodes.append(py::make_tuple(std::string(to_string(node.operation())),
                                is_primitive ? primitives[node.primitive()].id : std::string()));
  }
  return py::module_::import("cloud2csg.tree").attr("from_postfix")(nodes);
}

CsgTree to_tree(const py::object& tree, const PrimitiveSet& primitives) {
  if (py::isinstance<py::str>(tree)) return parse_tree(tree.cast<std::string>(), primitives);
  const py::module_ nodes = py::module_::import("cloud2csg.tree");
  if (py::isinstance(tree, nodes.attr("Node"))) return read_postfix(nodes.attr("postfix")(tree), primitives);
  throw py::type_error(
      fmt::format("tree: expected a tree node, a text or None, found {}", py::repr(tree).cast<std::string>()));
}

}  // namespace cloud2csg::python
