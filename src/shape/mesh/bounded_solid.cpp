#include "shape/mesh/bounded_solid.hpp"

#include <fmt/format.h>

#include <variant>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"

namespace cloud2csg {
namespace {

PrimitiveIndex add_box(PrimitiveSet& primitives, const Pose& pose, const Eigen::Vector3d& size) {
  primitives.push_back({.id = {}, .shape = Box{.size = size}, .pose = pose, .displacement = {}});
  return static_cast<PrimitiveIndex>(primitives.size() - 1);
}

/// Every leaf that is an expression becomes its intersection with a box.
CsgTree box_expressions(const CsgTree& tree, PrimitiveSet& primitives) {
  CsgTree result = tree;
  for (const PrimitiveIndex index : primitives_of(tree)) {
    if (!std::holds_alternative<Expression>(primitives[index].shape)) continue;
    const OrientedBox box = oriented_bounds(primitives[index]);
    const PrimitiveIndex cutter = add_box(primitives, box.pose, 2 * box.half_size);
    const CsgTree boxed = intersect(CsgTree::leaf(index), CsgTree::leaf(cutter));
    // From the root down, so that the nodes that are still to come keep their places.
    for (std::size_t node = result.size(); node-- > 0;) {
      if (result.nodes()[node] == CsgNode::leaf(index)) result.replace(node, boxed.nodes());
    }
  }
  return result;
}

}  // namespace

BoundedSolid bound_solid(const CsgTree& tree, const PrimitiveSet& primitives, const AlignedBox& bounds) {
  const AlignedBox own_bounds = bounds_of(tree, primitives);
  BoundedSolid solid{.tree = tree, .primitives = primitives, .bounds = own_bounds.intersection(bounds)};
  if (own_bounds.isEmpty() || solid.bounds.isEmpty()) return {};
  if (!solid.bounds.min().allFinite() || !solid.bounds.max().allFinite()) {
    throw Error({.file = {},
                 .where = "bounds",
                 .expected = "expected finite bounds for a solid that is not bounded itself",
                 .remedy = "intersect the solid with a box, or give bounds at which to cut it"});
  }
  solid.tree = box_expressions(tree, solid.primitives);
  if (!bounds.contains(own_bounds)) {
    // Where the solid ends within `bounds`, the cutter's face stays clear of the solid's.
    const Eigen::Vector3d clearance = Eigen::Vector3d::Constant(0.1 * solid.bounds.sizes().maxCoeff());
    const AlignedBox cut =
        bounds.intersection(AlignedBox(solid.bounds.min() - clearance, solid.bounds.max() + clearance));
    const PrimitiveIndex cutter = add_box(solid.primitives, {.position = cut.center()}, cut.sizes());
    solid.tree = intersect(solid.tree, CsgTree::leaf(cutter));
  }
  return solid;
}

}  // namespace cloud2csg
