#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/refine.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// Where a primitive's own axes point, and from where it is measured.
struct LocalFrame {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// A number of a primitive that can be moved without its orientation: where a face or a middle is along one of its own
/// axes, or a radius. Faces are given each by itself, not by middle and size, so that one that no point is on stays.
struct Slot {
  RegularityType kind;      ///< faces, centres or radii
  std::optional<int> axis;  ///< absent for radii, and for a polytope's planes, which lie in any direction
  double value;
};

/// None for expressions. The axes are those of the frame's orientation, which for a solid of revolution may be turned
/// around the axis.
[[nodiscard]] std::vector<Slot> slots_of(const Primitive& primitive, const LocalFrame& frame);

/// The primitive in the frame with other values in its slots; absent where that is no solid.
[[nodiscard]] std::optional<Primitive> with_slots(const Primitive& original, const LocalFrame& frame,
                                                  std::span<const double> values);

/// Whether turning around its own z axis does not change the solid.
[[nodiscard]] bool is_turned_around_axis(const Primitive& primitive);
/// Whether its orientation says nothing: an undisplaced sphere.
[[nodiscard]] bool has_no_orientation(const Primitive& primitive);

}  // namespace cloud2csg
