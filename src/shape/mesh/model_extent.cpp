#include "shape/mesh/model_extent.hpp"

#include <algorithm>

#include "cloud2csg/mesh.hpp"
#include "core/fields/bounded_field.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

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

}  // namespace

AlignedBox model_extent(const Model& model) {
  constexpr double k_room = 0.25;  // on each side, relative to the largest size
  AlignedBox extent;
  for (const PrimitiveIndex index : primitives_of(tree_of(model))) {
    const AlignedBox box = bounds(model.primitives[index]);
    if (is_finite(box)) {
      extent.extend(box);
    } else {
      extent.extend(model.primitives[index].pose.position);  // a half-space: at least shows its face
    }
  }
  if (extent.isEmpty()) extent = AlignedBox(Eigen::Vector3d::Zero().eval());
  const double largest = extent.sizes().maxCoeff();
  return grown(extent, largest > 0 ? k_room * largest : 1.0);
}

std::optional<AlignedBox> cut_at(const Model& model, const AlignedBox& extent) {
  if (extent.contains(bounds_of(model))) return {};
  const Model field = bounded_field(model);
  const std::vector<double> values = implicit_value(*field.tree, field.primitives, points_on_faces(extent));
  const bool goes_on = std::any_of(values.begin(), values.end(), [](double value) { return value < 0; });
  return goes_on ? std::optional(extent) : std::nullopt;
}

}  // namespace cloud2csg
