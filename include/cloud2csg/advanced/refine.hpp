#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Refinement: moves, turns and resizes primitives, to bring the surface of a tree over them nearest to the points.
namespace cloud2csg {

struct RefineOptions {
  std::optional<double> noise = {};
  double angle_tolerance_deg = 30.0;
  int rounds = 5;
  std::size_t most_points = 2000;
  bool regularise = true;
  double regularity_angle_deg = 0.5;
};
void option_table(OptionsOf<RefineOptions>, auto&& field) {
  using O = RefineOptions;
  field(&O::noise, "noise", "Standard deviation of the points from the true surface, in the cloud's units", above(0),
        {.absent = "measured as the primitives approach the points"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Largest angle between the normals of a point and of its primitive, in degrees. As in the segmentation.",
        above_to(0, 90));
  field(&O::rounds, "rounds",
        "Largest number of rounds, each of which assigns the points to the primitives again. For primitives off by one "
        "percent, the points are right after two or three rounds.",
        at_least(1));
  field(&O::most_points, "most_points",
        "Largest number of points per primitive, taken evenly in their order. Enough to place it to a fiftieth of the "
        "noise.",
        at_least(100));
  field(&O::regularise, "regularise", "Make nearly regular directions, faces, centres and radii exactly regular");
  field(&O::regularity_angle_deg, "regularity_angle_deg",
        "Largest angle by which directions may miss being parallel or orthogonal to be made so, in degrees. Less "
        "certain directions: three of their standard deviations. Small, since refined primitives are right to a tenth "
        "of a degree.",
        above_to(0, 10));
}

enum class RegularityType {
  directions,  ///< parallel or orthogonal axes and faces
  faces,       ///< coplanar faces
  centres,     ///< aligned centres; coaxial cylinders count once for each of two directions
  radii,
};
constexpr auto names_of(RegularityType /*any*/) {
  return std::to_array<EnumName<RegularityType>>({{"directions", RegularityType::directions},
                                                  {"faces", RegularityType::faces},
                                                  {"centres", RegularityType::centres},
                                                  {"radii", RegularityType::radii}});
}

/// Primitives that are exactly regular in the result.
struct Regularity {
  RegularityType type;
  std::vector<PrimitiveIndex> primitives;  ///< ascending; a primitive appears twice with two coplanar faces
  double spread;                           ///< largest difference before, in radians or the cloud's units
};

struct PrimitiveChange {
  std::size_t points = 0;    ///< points of its fit; 0: unchanged
  double largest_shift = 0;  ///< largest move of a centre, face or radius, in the cloud's units
  double turn_deg = 0;       ///< turn of the axis or, without an axis, of the whole
  double rms_before = 0;     ///< root mean square distance of its points, without outliers
  double rms_after = 0;
};

struct Refinement {
  PrimitiveSet primitives;               ///< the given number and order, with their ids, types and displacements
  bool is_better = false;                ///< false: `primitives` are the given ones
  std::vector<PrimitiveChange> changes;  ///< by primitive
  std::vector<Regularity> regularities;
  std::size_t points = 0;  ///< points of any primitive's fit
  double rms_before = 0;   ///< root mean square distance of the points from their primitives, without outliers
  double rms_after = 0;
  double noise = 0;  ///< given, or measured at the end
  int rounds = 0;
};

/// Robust least squares over the poses and sizes of all primitives of a fixed tree. A point counts for the primitive
/// whose value the tree takes there, if that is near zero and the normals agree; each round assigns the points anew.
/// Values that no point determines stay, such as the end of a bore in the air or the face of a box inside another one.
/// Expressions and primitives without points stay. A polytope turns and its planes shift at fixed angles. A cone keeps
/// its apex, if it has one.
/// Regularities are found among values that the points determine, and kept where they were exact before. Regular
/// directions turn together and equal values are one unknown, so they hold exactly. Regularities that the points
/// contradict are dropped.
/// Returns the given primitives where the tree's surface comes no nearer to the points, by the same loss. Does not
/// depend on threads. O(rounds x points x (primitives + unknowns of each))
/// @throws Error as validate(); Cancelled.
/// Preconditions: the cloud has normals; valid primitives; the tree is over them.
[[nodiscard]] Refinement refine_primitives(const PointCloud& cloud, const PrimitiveSet& primitives, const CsgTree& tree,
                                           const RefineOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
