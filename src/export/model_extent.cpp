#include "export/model_extent.hpp"

namespace cloud2csg {

AlignedBox model_extent(const CsgTree& tree, const PrimitiveSet& primitives) {
  constexpr double k_room = 0.25;  // on each side, as a part of the largest size
  AlignedBox extent;
  for (const PrimitiveIndex index : primitives_of(tree)) {
    const AlignedBox box = bounds(primitives[index]);
    if (box.min().allFinite() && box.max().allFinite()) {
      extent.extend(box);
    } else {
      extent.extend(primitives[index].pose.position);  // a half-space: at least show where its face is
    }
  }
  if (extent.isEmpty()) extent = AlignedBox(Eigen::Vector3d::Zero().eval());
  const double largest = extent.sizes().maxCoeff();
  const Eigen::Vector3d room = Eigen::Vector3d::Constant(largest > 0 ? k_room * largest : 1.0);
  return {extent.min() - room, extent.max() + room};
}

}  // namespace cloud2csg
