#include "core/fields/bounded_field.hpp"

#include <variant>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

/// Bounds of a solid and of its complement.
struct Bounds {
  AlignedBox inside;
  AlignedBox outside;
};

AlignedBox common(const AlignedBox& a, const AlignedBox& b) {
  const AlignedBox box = a.intersection(b);
  return box.isEmpty() ? AlignedBox() : box;  // one representation of nothing, so that merging with it is harmless
}

Bounds complement_of(const Bounds& a) {
  return {.inside = a.outside, .outside = a.inside};
}

Bounds union_of(const Bounds& a, const Bounds& b) {
  return {.inside = a.inside.merged(b.inside), .outside = common(a.outside, b.outside)};
}

Bounds bounds_of_leaf(const CsgNode& node, const PrimitiveSet& primitives) {
  if (node.operation() == Operation::empty) return {.inside = AlignedBox(), .outside = everywhere()};
  if (node.operation() == Operation::full) return {.inside = everywhere(), .outside = AlignedBox()};
  return {.inside = bounds(primitives[node.primitive()]), .outside = everywhere()};
}

}  // namespace

Model bounded_field(const Model& solid) {
  Model field{.primitives = solid.primitives, .tree = tree_of(solid)};
  for (const PrimitiveIndex index : primitives_of(*field.tree)) {
    if (!std::holds_alternative<Expression>(solid.primitives[index].shape)) continue;
    const auto cutter = static_cast<PrimitiveIndex>(field.primitives.size());
    const OrientedBox box = oriented_bounds(solid.primitives[index]);
    field.primitives.push_back({.id = {}, .shape = Box{.size = 2 * box.half_size}, .pose = box.pose});
    const CsgTree boxed = intersect(CsgTree::leaf(index), CsgTree::leaf(cutter));
    // Start at the root, so that the nodes still to come keep their places.
    for (std::size_t node = field.tree->size(); node-- > 0;) {
      if (field.tree->nodes()[node] == CsgNode::leaf(index)) field.tree->replace(node, boxed.nodes());
    }
  }
  return field;
}

AlignedBox bounds_of(const Model& model) {
  std::vector<Bounds> stack;
  for (const CsgNode& node : tree_of(model).nodes()) {
    if (node.is_leaf()) {
      stack.push_back(bounds_of_leaf(node, model.primitives));
      continue;
    }
    const Bounds last = stack.back();
    stack.pop_back();
    if (node.operation() == Operation::complement) {
      stack.push_back(complement_of(last));
      continue;
    }
    Bounds& first = stack.back();
    if (node.operation() == Operation::union_of) {
      first = union_of(first, last);
    } else {  // a & b = ~(~a | ~b), a - b = ~(~a | b)
      const Bounds not_last = node.operation() == Operation::difference ? last : complement_of(last);
      first = complement_of(union_of(complement_of(first), not_last));
    }
  }
  return stack.back().inside;
}

}  // namespace cloud2csg
