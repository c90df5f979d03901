#include "core/fields/bounded_field.hpp"

#include <variant>

namespace cloud2csg {

Model bounded_field(const Model& solid) {
  Model field{.primitives = solid.primitives, .tree = tree_of(solid)};
  for (const PrimitiveIndex index : primitives_of(*field.tree)) {
    if (!std::holds_alternative<Expression>(solid.primitives[index].shape)) continue;
    const auto cutter = static_cast<PrimitiveIndex>(field.primitives.size());
    const OrientedBox box = oriented_bounds(solid.primitives[index]);
    field.primitives.push_back({.id = {}, .shape = Box{.size = 2 * box.half_size}, .pose = box.pose});
    const CsgTree boxed = intersect(CsgTree::leaf(index), CsgTree::leaf(cutter));
    // From the root down, so that the nodes that are still to come keep their places.
    for (std::size_t node = field.tree->size(); node-- > 0;) {
      if (field.tree->nodes()[node] == CsgNode::leaf(index)) field.tree->replace(node, boxed.nodes());
    }
  }
  return field;
}

}  // namespace cloud2csg
