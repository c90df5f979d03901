#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

/// Refinement: primitives that were fitted roughly are moved, turned and sized so that the surface of a tree over them
/// is as near to the points as it can be.
namespace cloud2csg {

/// Its fields: see the table.
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
        {.absent = "measured while the primitives come nearer to the points"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "A point tells of a primitive when its normal is within so many degrees of the surface's. As in the "
        "segmentation.",
        above_to(0, 90));
  field(&O::rounds, "rounds",
        "Times that the points are dealt out to the primitives anew. Of primitives off by one percent, the points are "
        "right after two or three.",
        at_least(1));
  field(&O::most_points, "most_points",
        "So many of a primitive's points are taken, evenly over their order. Enough to place it to a fiftieth of "
        "the noise.",
        at_least(100));
  field(&O::regularise, "regularise", "Take what is nearly regular for regular");
  field(&O::regularity_angle_deg, "regularity_angle_deg",
        "Directions within so many degrees of being parallel or orthogonal are made so. Those that are more uncertain "
        "than that, within three of their standard deviations. Small: refined primitives are right to a tenth of a "
        "degree.",
        above_to(0, 10));
}

enum class RegularityType {
  directions,  ///< axes and faces that are parallel or orthogonal to each other
  faces,       ///< parallel faces in one plane
  centres,     ///< middles in line: of two cylinders, once for each of two directions, that they have one axis
  radii,       ///< equal radii
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
  std::vector<PrimitiveIndex> primitives;  ///< ascending; one may be named twice, with two faces in a plane
  double spread;  ///< how far apart they were before: the largest difference, in radians or the cloud's units
};

/// What became of a primitive.
struct PrimitiveChange {
  std::size_t points = 0;    ///< that it was refined on; 0: left as it was
  double largest_shift = 0;  ///< of a centre, face or radius, in the cloud's units
  double turn_deg = 0;       ///< of its axis or, where it has none, of the whole
  double rms_before = 0;     ///< of its points' distances from it, those that are no outliers
  double rms_after = 0;
};

struct Refinement {
  PrimitiveSet primitives;               ///< as many as given, in their order, with their ids, types and displacements
  bool is_better = false;                ///< false: `primitives` are those that were given
  std::vector<PrimitiveChange> changes;  ///< by primitive
  std::vector<Regularity> regularities;
  std::size_t points = 0;  ///< that some primitive was refined on
  double rms_before = 0;   ///< of the distances of these points from their primitives, outliers left out
  double rms_after = 0;
  double noise = 0;  ///< that was given or measured in the end
  int rounds = 0;
};

/// Least squares, with a robust loss, over the poses and sizes of all primitives of the tree, with the tree as it is. A
/// point counts for the primitive whose value the tree takes there, where that is near zero and the normals agree; that
/// is found anew each round. What no point determines stays: the end of a bore that is in the air, or a face of a box
/// that is within another. Expressions, and primitives without points, stay as they are; a polytope is turned and its
/// planes are shifted, but the angles between them stay; a cone keeps its apex, if it has one.
/// Regularities are found among what the points determine, and kept where they were exact before: directions are then
/// turned together, and equal values are one unknown, so that they hold exactly. They are given up where the points
/// contradict them.
/// Where the tree's surface is not nearer to the points than before, by the same loss, the primitives that were given
/// are returned. O(rounds x points x (primitives + unknowns of each)); the result does not depend on the threads.
/// @throws Error as validate(); Cancelled.
/// Preconditions: the cloud has normals; valid primitives; the tree is over them.
[[nodiscard]] Refinement refine_primitives(const PointCloud& cloud, const PrimitiveSet& primitives, const CsgTree& tree,
                                           const RefineOptions& options = {}, const RunContext& run = {});

}  // namespace cloud2csg
