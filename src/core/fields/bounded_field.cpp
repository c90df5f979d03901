#include "core/fields/bounded_field.hpp"

#include <variant>

namespace cloud2csg {

BoundedField bounded_field(const CsgTree& tree, const PrimitiveSet& primitives) {
  BoundedField field{.tree = tree, .primitives = primitives};
  for (const PrimitiveIndex index : primitives_of(tree)) {
    if (!std::holds_alternative<Expression>(primitives[index].shape)) continue;
    const auto cutter = static_cast<PrimitiveIndex>(field.primitives.size());
    const OrientedBox box = oriented_bounds(primitives[index]);
    field.primitives.push_back({.id = {}, .shape = Box{.size = 2 * box.half_size}, .pose = box.pose});
    const CsgTree boxed = intersect(CsgTree::leaf(index), CsgTree::leaf(cutter));
    // From the root down, so that the nodes that are still to come keep their places.
    for (std::size_t node = field.tree.size(); node-- > 0;) {
      if (field.tree.nodes()[node] == CsgNode::leaf(index)) field.tree.replace(node, boxed.nodes());
    }
  }
  return field;
}

}  // namespace cloud2csg
