#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/refine.hpp"
#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// The axes and origin in which a primitive is measured.
struct LocalFrame {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// A movable value of a primitive besides its orientation: a face's or centre's position along one of its own axes, or
/// a radius. Each face has its own slot instead of centre and size, so a face without points stays.
struct Slot {
  RegularityType kind;      ///< faces, centres or radii
  std::optional<int> axis;  ///< absent for radii and for a polytope's planes
  double value;
};

/// Empty for expressions. Axes are those of the frame; for a solid of revolution they may be turned around the axis.
[[nodiscard]] std::vector<Slot> slots_of(const Primitive& primitive, const LocalFrame& frame);

/// The primitive in the frame with new slot values; absent for degenerate solids.
[[nodiscard]] std::optional<Primitive> with_slots(const Primitive& original, const LocalFrame& frame,
                                                  std::span<const double> values);

/// Whether rotation around its own z axis leaves the solid unchanged.
[[nodiscard]] bool is_turned_around_axis(const Primitive& primitive);
/// Whether the orientation has no meaning: an undisplaced sphere.
[[nodiscard]] bool has_no_orientation(const Primitive& primitive);

}  // namespace cloud2csg
