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

/// Its fields: see the table.
struct PlaceOptions {
  std::optional<double> noise = {};
  std::size_t volume_places = 30'000, surface_points = 8'000;
  double margin = 0.06;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<PlaceOptions>, auto&& field) {
  using O = PlaceOptions;
  field(&O::noise, "noise", "Standard deviation of the points from the surface, in the cloud's units", at_least(0),
        {.absent = "a tenth of the spacing"});
  field(&O::volume_places, "volume_places", "Places that are spread over the cloud's bounds, grown by `margin`",
        at_least(1));
  field(&O::surface_points, "surface_points", "Points that have a place on either side, at most", at_least(1));
  field(&O::margin, "margin", "Share of the diagonal around the cloud: what is outside must be seen on all sides",
        above_to(0, 1));
  field(&O::seed, k_inner_seed);
}

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

/// Its fields: see the table.
struct RegularityOptions {
  bool snap = true;
  double angle_tolerance_deg = 1.0;
  std::optional<double> distance_tolerance = {};
  std::vector<double> radii = {};
  std::vector<Eigen::Vector3d> axes = {};
  double axis_tolerance_deg = 5.0;
  std::optional<double> given_tolerance = {};
};
void option_table(OptionsOf<RegularityOptions>, auto&& field) {
  using O = RegularityOptions;
  field(&O::snap, "snap",
        "Make surfaces like each other: directions, offsets and radii that nearly are. What is given below holds in "
        "any case.",
        {.opposite = "no-snap",
         .otherwise = "Keep directions, offsets and radii as they were measured: nothing is made parallel or equal, "
                      "but for what `radii` and `axes` say"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Directions nearer than so many degrees to each other, or to an orthogonal one, are made so. See regularise().",
        above(0), k_library);
  field(&O::distance_tolerance, "distance_tolerance",
        "Offsets, centres and radii nearer than this are made equal, in the cloud's units", above(0),
        {.absent = "twice the noise, at least 1e-3 of the cloud's diagonal", .option = k_no_option});
  field(&O::radii, "radii",
        "Radii that spheres, cylinders and tori are known to have, as in 2.5,3,6: each takes the nearest of them, "
        "unless its points contradict. It is put where it suits its points best with that radius.",
        above(0), {.unit = "R,R..."});
  field(&O::axes, "axes",
        "Directions that planes, cylinders, cones and tori are known to have, as in x,y,z or x,1,1,0: each takes one "
        "that is within 5 degrees, unless its points contradict. Of any length, either way round. Within "
        "`axis_tolerance_deg`; up to `angle_tolerance_deg` points are not asked.",
        above(0), {.unit = "A,A..."});
  field(&O::axis_tolerance_deg, "axis_tolerance_deg",
        "Surfaces nearer than so many degrees to a given direction take it", above(0), k_library);
  field(&O::given_tolerance, "given_tolerance",
        "How much farther points may be from a surface with given values, in the cloud's units. find_primitives() "
        "takes the tolerance of the detection where it is absent.",
        above(0), {.absent = "the distance tolerance in force", .option = k_no_option});
}

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

/// Its fields: see the table.
struct SolidOptions {
  double leaf_cost = 0.001, plane_cost = 0.2;
  std::size_t most_rules = 1024;
  PlaceOptions places = {};
  std::size_t volume_places_a_surface = 400, surface_points_a_surface = 100;
  RegularityOptions regularity = {};
};
void option_table(OptionsOf<SolidOptions>, auto&& field) {
  using O = SolidOptions;
  field(&O::leaf_cost, "leaf_cost",
        "What a leaf more must gain, as a share of volume and surface: more gives smaller trees. In the weight of "
        "places. One permille: a hole of that share of the volume or of the surface is worth a leaf.",
        above_to(0, 1), {.unit = "SHARE"});
  field(&O::plane_cost, "plane_cost",
        "Cost of a plane of a polytope beyond the sixth, in leaves. So a box is preferred where it is as good.",
        above(0), k_library);
  field(&O::most_rules, "most_rules",
        "Rules of the decision list; a guard, and a warning says where it ended the choice", at_least(1), k_library);
  field(&O::places, "places", "Places by which solids are judged", k_library);
  field(&O::volume_places_a_surface, "volume_places_a_surface",
        "Places in the volume for each surface, where that is more than `places` has. With fewer, a hole among "
        "hundreds is a matter of chance.",
        k_library);
  field(&O::surface_points_a_surface, "surface_points_a_surface",
        "Points with places beside them for each surface, where that is more", k_library);
  field(&O::regularity, "regularity", "What of the surfaces is made regular");
}

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
