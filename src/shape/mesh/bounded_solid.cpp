#include "shape/mesh/bounded_solid.hpp"

#include <fmt/format.h>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {

BoundedSolid bound_solid(const Model& model, const AlignedBox& bounds) {
  const AlignedBox own_bounds = bounds_of(model);
  Model field = bounded_field(model);
  BoundedSolid solid{std::move(*field.tree), std::move(field.primitives), own_bounds.intersection(bounds)};
  if (own_bounds.isEmpty() || solid.bounds.isEmpty()) return {};
  if (!is_finite(solid.bounds)) {
    throw Error({.where = "bounds",
                 .expected = "expected finite bounds for a solid that is not bounded itself",
                 .remedy = "intersect the solid with a box, or give bounds at which to cut it"});
  }
  if (!bounds.contains(own_bounds)) {
    // Where the solid ends within `bounds`, the cutter's face stays clear of the solid's.
    const AlignedBox cut = bounds.intersection(grown(solid.bounds, 0.1 * solid.bounds.sizes().maxCoeff()));
    solid.tree = intersect(solid.tree, CsgTree::leaf(static_cast<PrimitiveIndex>(solid.primitives.size())));
    solid.primitives.push_back({.id = {}, .shape = Box{.size = cut.sizes()}, .pose = {.position = cut.center()}});
  }
  return solid;
}

}  // namespace cloud2csg
