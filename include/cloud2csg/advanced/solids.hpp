#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/advanced/detect.hpp"
#include "cloud2csg/advanced/segmentation.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"

/// From detected surfaces to few solids and a small tree over them.
namespace cloud2csg {

/// Places of which it is known whether they are in the solid.
struct LabelledPlaces {
  Points positions = {};
  /// One a place: how much it counts, positive in the solid, negative outside. Places all over the volume weigh 1 in
  /// all per volume of the solid, those just beside the surface 1 for all of the surface.
  std::vector<double> weights = {};
};

struct PlaceOptions {
  /// Standard deviation of the points from the surface, in the cloud's units. Absent: a tenth of the spacing.
  std::optional<double> noise = {};
  std::size_t volume_places = 30'000;  ///< spread over the cloud's bounds, grown by `margin`
  std::size_t surface_points = 8'000;  ///< points that have a place on either side, at most
  double margin = 0.06;                ///< of the diagonal: what is outside must be seen on all sides
  std::uint64_t seed = 1;
};

/// Places in the volume are labelled by the winding number of the oriented points (Barill et al. 2018), those beside a
/// point by its normal. Unclear ones are left out. O((places + points) log points) and places x occupied voxels, of
/// which there are some thousands.
/// @throws Error (where = "cloud", "noise"...) when the cloud has no normals, fewer than 16 points, or no inside, or an
/// option is out of range; Cancelled.
[[nodiscard]] LabelledPlaces label_places(const PointCloud& cloud, const PlaceOptions& options = {},
                                          const RunContext& run = {});

/// The weight of the places that a tree labels otherwise; 0 when it is right everywhere. O(places x size).
[[nodiscard]] double wrong_place_share(const CsgTree& tree, const PrimitiveSet& solids, const LabelledPlaces& places);

/// Of the places that a tree labels otherwise, the one deepest inside or farthest outside of its solid. O(places x
/// size). Precondition: there is one.
[[nodiscard]] Eigen::Vector3d worst_place(const CsgTree& tree, const PrimitiveSet& solids,
                                          const LabelledPlaces& places);

struct RegularityOptions {
  /// False: surfaces are not made like each other. What is given below holds all the same.
  bool snap = true;
  /// Directions nearer than this to each other, or to an orthogonal one, are made so; see regularise().
  double angle_tolerance_deg = 1.0;
  /// Offsets, centres and radii nearer than this are made equal, in the cloud's units. Absent: twice the noise, at
  /// least 1e-3 of the cloud's diagonal.
  std::optional<double> distance_tolerance = {};
  /// Radii that spheres, cylinders and tori are known to have. Each takes the nearest of them, and the place that suits
  /// its points best with it, where that is by no more than `given_tolerance` farther from these; else it stays as it
  /// is.
  std::vector<double> radii = {};
  /// Directions that planes, cylinders, cones and tori are known to have, either way round, of any length. Each takes
  /// the nearest within `axis_tolerance_deg`, as long as its points bear that out as for radii; up to
  /// `angle_tolerance_deg` they are not asked.
  std::vector<Eigen::Vector3d> axes = {};
  double axis_tolerance_deg = 5.0;
  /// In the cloud's units. Absent: the distance tolerance in force; in find_primitives() that of the detection.
  std::optional<double> given_tolerance = {};
};

enum class RegularityKind : std::uint8_t {
  direction,
  offset,
  axis,
  radius,
  given_direction,
  given_radius,
  arrangement
};
/// "direction", "offset", "axis", "radius", "given direction", "given radius", "arrangement".
[[nodiscard]] std::string_view to_string(RegularityKind kind);

/// What was snapped.
struct Snap {
  RegularityKind kind = RegularityKind::direction;
  std::uint32_t surface = 0;  ///< index into the surfaces
  double change = 0;          ///< of a direction in degrees, of the others in units of length
};

/// Of directions in degrees, of all others in units of length; 0 where there are none.
struct LargestChange {
  double turn_deg = 0, shift = 0;
};
/// O(snaps).
[[nodiscard]] LargestChange largest_change(std::span<const Snap> snaps);

struct RegularSurfaces {
  std::vector<DetectedSurface> surfaces = {};  ///< as many as there were, in the same order
  std::vector<Snap> snaps = {};
};

/// What of a surface is known: it is not changed, and others are made like it.
struct FixedValues {
  bool direction = false, position = false, radius = false;
};

/// Makes directions that nearly are so equal or orthogonal, planes that nearly are so coplanar, axes coaxial, radii
/// equal. A direction is laid along an axis of coordinates where that moves no surface by more than the distance
/// tolerance: a part that lies so is easier to edit. A value that several share is the mean by their points, so what
/// has more is moved less. Parallel axes of cylinders of equal radius are put into rows and grids of equal steps and
/// into circles of equal angles (regular_places.hpp). Turned surfaces keep their position, which should be near their
/// points. Where a surface's own points leave its direction more open (DetectedSurface::turn_deg), it is turned up to
/// three standard deviations, at most three times the angle. `fixed` has one a surface, or none. O(surfaces^2).
[[nodiscard]] RegularSurfaces regularise(std::span<const DetectedSurface> surfaces, double distance_tolerance,
                                         double angle_tolerance_deg = RegularityOptions{}.angle_tolerance_deg,
                                         std::span<const FixedValues> fixed = {});

struct SolidOptions {
  /// What a leaf more must gain, in the weight of places: see LabelledPlaces. One permille: a hole of that share of the
  /// volume or of the surface is worth a leaf.
  double leaf_cost = 0.001;
  /// What a plane of a polytope beyond the sixth costs, in leaves: a box is preferred where it is as good.
  double plane_cost = 0.2;
  std::size_t most_rules = 1024;  ///< of the decision list; a guard, and a warning says where it ended the choice
  PlaceOptions places = {};
  /// Places in the volume, and points with places beside them, for each surface, where that is more than `places` has:
  /// with fewer, a hole among hundreds is a matter of chance.
  std::size_t volume_places_a_surface = 400, surface_points_a_surface = 100;
  RegularityOptions regularity = {};
};

/// @throws Error naming the field when an option is out of range.
void validate(const SolidOptions& options);

/// A solid that is known, and the points that lie on its surface. They should not be those of detected surfaces.
struct KnownSolid {
  Primitive solid;
  SurfacePoints own = {};
};

struct SolidChoice {
  /// Those that are known first, as they are; then others, with ids by type and number: "box_0", "cylinder_1"...
  PrimitiveSet solids = {};
  CsgTree tree = {};        ///< over the solids, simplified
  double disagreement = 0;  ///< of the tree with the places
  LabelledPlaces places = {};
  std::vector<Snap> snaps = {};
  std::vector<std::string> warnings = {};  ///< sentences for the user: given values that the points do not bear out
};

/// Few solids that surfaces bound, and a tree over them: a decision list of terms (boxes, cylinders, cones, spheres,
/// tori, polytopes, and parts that two of them have in common), each of which is in or out of the solid where none
/// before it decides. Terms are not listed: the one that gains most is searched for, again and again, and rules are
/// taken back or exchanged as long as that lowers disagreement plus leaves. The result does not depend on the number of
/// threads. Stopped early, the tree is the best so far.
/// @throws Error when the cloud has no normals, there are no surfaces or an option is out of range; Cancelled when
/// stopped before the search.
[[nodiscard]] SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        const SolidOptions& options = {}, const RunContext& run = {});

/// The same beside solids that are known. These are terms as they are, of any type, and preferred to others that are as
/// good; their faces are among those that solids may end at, and detected surfaces are made like them, not they like
/// these. No surfaces are needed where a known solid has points.
[[nodiscard]] SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        std::span<const KnownSolid> known, const SolidOptions& options,
                                        const RunContext& run);

}  // namespace cloud2csg
