#include "shape/mesh/model_extent.hpp"

#include <algorithm>
#include <variant>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {
namespace {

/// A lattice on all six faces.
Points points_on_faces(const AlignedBox& box) {
  constexpr int k_steps = 128;
  Points points;
  points.reserve(std::size_t{6} * (k_steps + 1) * (k_steps + 1));
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i <= k_steps; ++i) {
      for (int j = 0; j <= k_steps; ++j) {
        Eigen::Vector3d place;  // 0 to 1
        place[(axis + 1) % 3] = static_cast<double>(i) / k_steps;
        place[(axis + 2) % 3] = static_cast<double>(j) / k_steps;
        for (const double side : {0.0, 1.0}) {
          place[axis] = side;
          points.push_back(box.min() + place.cwiseProduct(box.sizes()));
        }
      }
    }
  }
  return points;
}

/// Beyond its bounds the formula of an expression means nothing: there it is as much outside as its box.
PrimitiveSet with_boxes_for_expressions(PrimitiveSet primitives) {
  for (Primitive& primitive : primitives) {
    if (!std::holds_alternative<Expression>(primitive.shape)) continue;
    const OrientedBox box = oriented_bounds(primitive);
    primitive.shape = Box{.size = 2 * box.half_size};
    primitive.pose = box.pose;
    primitive.displacement.reset();
  }
  return primitives;
}

}  // namespace

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

std::optional<AlignedBox> cut_at(const CsgTree& tree, const PrimitiveSet& primitives, const AlignedBox& extent) {
  if (extent.contains(bounds_of(tree, primitives))) return {};
  const std::vector<double> values =
      implicit_value(tree, with_boxes_for_expressions(primitives), points_on_faces(extent));
  const bool goes_on = std::any_of(values.begin(), values.end(), [](double value) { return value < 0; });
  return goes_on ? std::optional(extent) : std::nullopt;
}

}  // namespace cloud2csg
