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
#include "cloud2csg/error.hpp"
#include "cloud2csg/point_cloud.hpp"

/// From detected surfaces to few solids and a small tree over them.
namespace cloud2csg {

/// The surface of the cloud encloses nothing.
class NoInside : public Error {
 public:
  using Error::Error;
};

/// Places with a known label: in the solid or out of it.
struct LabelledPlaces {
  Points positions = {};
  /// One per place: positive in the solid, negative outside. Volume places weigh 1 in total per volume of the solid;
  /// places just beside the surface weigh 1 in total for the whole surface, and so would places beside all of a chosen
  /// solid's surface: there are some only where no point is near it.
  std::vector<double> weights = {};
};

struct PlaceOptions {
  std::optional<double> noise = {};
  std::size_t volume_places = 30'000, surface_points = 8'000;
  double margin = 0.06;
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<PlaceOptions>, auto&& field) {
  using O = PlaceOptions;
  field(&O::noise, "noise", "Standard deviation of the points from the surface, in the cloud's units", at_least(0),
        {.absent = "a tenth of the point spacing"});
  field(&O::volume_places, "volume_places",
        "Number of places spread over the cloud's bounds, which are grown by `margin`", at_least(1));
  field(&O::surface_points, "surface_points", "Largest number of points that have a place on either side", at_least(1));
  field(&O::margin, "margin",
        "Margin around the cloud, as a share of its diagonal: the outside must be seen on all sides", above_to(0, 1));
  field(&O::seed, k_inner_seed);
}

/// Labels places in the volume by the winding number of the oriented points (Barill et al. 2018) and places beside a
/// point by its normal. If the cloud has sensor positions, places on lines of sight away from all points are outside.
/// Leaves out unclear places. `areas`: of the surface around each point, by point_areas(); measured if empty.
/// O((places + points) log points + places x some thousand voxels + points x places^(1/3))
/// @throws NoInside; Error (where = "cloud", "noise"...) for no normals, fewer than 16 points, a bad option; Cancelled
[[nodiscard]] LabelledPlaces label_places(const PointCloud& cloud, const PlaceOptions& options = {},
                                          const RunContext& run = {}, std::span<const double> areas = {});

/// Total weight of the places that the tree labels differently; 0 when it is right everywhere. O(places x size).
[[nodiscard]] double wrong_place_share(const CsgTree& tree, const PrimitiveSet& solids, const LabelledPlaces& places);

/// The wrongly labelled place deepest inside or farthest outside. O(places x size). Precondition: there is one.
[[nodiscard]] Eigen::Vector3d worst_place(const CsgTree& tree, const PrimitiveSet& solids,
                                          const LabelledPlaces& places);

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
        "Make nearly equal directions, offsets and radii exactly equal. Values given by `radii` and `axes` apply in "
        "any case.",
        {.opposite = "no-snap",
         .otherwise = "Keep directions, offsets and radii as measured: make nothing parallel or equal, except by "
                      "`radii` and `axes`"});
  field(&O::angle_tolerance_deg, "angle_tolerance_deg",
        "Angle below which directions are made equal or orthogonal, in degrees. See regularise().", above(0),
        k_library);
  field(&O::distance_tolerance, "distance_tolerance",
        "Difference below which offsets, centres and radii are made equal, in the cloud's units", above(0),
        {.absent = "twice the noise, at least 1e-3 of the cloud's diagonal", .option = k_no_option});
  field(&O::radii, "radii",
        "Known radii of spheres, cylinders and tori, as in 2.5,3,6: each surface takes the nearest one, unless its "
        "points contradict. It moves to where it fits its points best with that radius.",
        above(0), {.unit = "R,R..."});
  field(&O::axes, "axes",
        "Known directions of planes, cylinders, cones and tori, as in x,y,z or x,1,1,0: each surface takes one within "
        "5 degrees, unless its points contradict. Length and sign do not matter. Within `axis_tolerance_deg`; within "
        "`angle_tolerance_deg` whatever the points say.",
        above(0), {.unit = "A,A..."});
  field(&O::axis_tolerance_deg, "axis_tolerance_deg", "Angle within which surfaces take a given direction, in degrees",
        above(0), k_library);
  field(&O::given_tolerance, "given_tolerance",
        "Largest additional distance of points from a surface with given values, in the cloud's units. If absent, "
        "find_primitives() uses the tolerance of the detection.",
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

/// One value that was made regular.
struct Snap {
  RegularityKind kind = RegularityKind::direction;
  std::uint32_t surface = 0;  ///< index into the surfaces
  double change = 0;          ///< degrees for a direction, else units of length
};

/// Turns in degrees, all other changes in units of length; 0 without any.
struct LargestChange {
  double turn_deg = 0, shift = 0;
};
/// O(snaps).
[[nodiscard]] LargestChange largest_change(std::span<const Snap> snaps);

struct RegularSurfaces {
  std::vector<DetectedSurface> surfaces = {};  ///< the given number and order
  std::vector<Snap> snaps = {};
};

/// The known values of a surface: they stay, and other surfaces adapt to them.
struct FixedValues {
  bool direction = false, position = false, radius = false;
};

/// Makes nearly equal or orthogonal directions exact, nearly equal planes coplanar, axes coaxial and radii equal.
/// Aligns a direction with a coordinate axis where that moves no surface by more than the distance tolerance; aligned
/// parts are easier to edit. A shared value is the mean weighted by points, so a surface with more points moves less.
/// Puts parallel axes of cylinders of equal radius into rows and grids of equal steps and circles of equal angles
/// (regular_places.hpp). Turned surfaces keep their position, which should be near their points. Where a surface's own
/// points leave its direction uncertain (DetectedSurface::turn_deg), it turns by up to three standard deviations, at
/// most three times the angle. With `positions`, those of the cloud, a surface that leaves its points when its
/// direction or axis changes is fitted to them anew, and its axis may then move by three standard deviations, at most
/// three tolerances. `fixed` has one entry per surface, or none. Surfaces with a fixed position or radius are not
/// fitted. O(surfaces^2 + points).
[[nodiscard]] RegularSurfaces regularise(std::span<const DetectedSurface> surfaces, double distance_tolerance,
                                         double angle_tolerance_deg = RegularityOptions{}.angle_tolerance_deg,
                                         std::span<const FixedValues> fixed = {}, const Points& positions = {});

struct SolidOptions {
  double leaf_cost = 0.001;
  std::size_t most_rules = 1024;
  PlaceOptions places = {};
  std::size_t volume_places_a_surface = 400, surface_points_a_surface = 100;
  RegularityOptions regularity = {};
};
void option_table(OptionsOf<SolidOptions>, auto&& field) {
  using O = SolidOptions;
  field(&O::leaf_cost, "leaf_cost",
        "Share of volume and surface that an additional leaf must gain; larger values give smaller trees. In the "
        "weight of places. 0.001: a hole with that share of the volume or the surface is worth a leaf.",
        above_to(0, 1), {.unit = "SHARE"});
  field(&O::most_rules, "most_rules",
        "Largest number of rules of the decision list; a safeguard, with a warning where it ends the choice",
        at_least(1), k_library);
  field(&O::places, "places", "Sample places by which solids are judged", k_library);
  field(&O::volume_places_a_surface, "volume_places_a_surface",
        "Places in the volume per surface, if that gives more than `places`. With fewer, finding a hole among hundreds "
        "is a matter of chance.",
        k_library);
  field(&O::surface_points_a_surface, "surface_points_a_surface",
        "Points with places beside them per surface, if that gives more than `places`", k_library);
  field(&O::regularity, "regularity", "Regularity of the surfaces");
}

/// A known solid and the points on its surface, which should not belong to detected surfaces.
struct KnownSolid {
  Primitive solid;
  SurfacePoints own = {};
};

/// A search for the tree, or an improvement of the last round's tree. What sticks out is cut off after the last round.
struct ChoiceRound {
  std::size_t planes = 0;   ///< added: they separate the solid from lumps that are wrongly in it
  std::size_t places = 0;   ///< added: beside surface that no point is near
  std::size_t leaves = 0;   ///< of the tree
  double disagreement = 0;  ///< wrong_place_share() of the tree by the places so far, which may be more each round
};

struct SolidChoice {
  /// The known solids first, unchanged; then new ones with ids by type and number: "box_0", "cylinder_1"...
  PrimitiveSet solids = {};
  CsgTree tree = {};        ///< over the solids, simplified
  double disagreement = 0;  ///< wrong_place_share() of the tree
  LabelledPlaces places = {};
  std::vector<ChoiceRound> rounds = {};  ///< those that lowered the cost; the first is the search
  std::vector<Snap> snaps = {};
  std::vector<std::string> warnings = {};  ///< sentences for the user: given values that the points do not support
};

/// Chooses few solids bounded by the surfaces, and where these do not suffice by separating planes, and a tree over
/// them. The tree is a decision list of terms: extrusions and revolutions of profiles (boxes, cylinders, cones, spheres
/// and tori where they are such), polytopes, and intersections of a profile with a curved surface's inside or outside.
/// The first term that contains a place says whether it is in the solid. Terms are not enumerated: the search
/// repeatedly adds the term that gains most, and removes or exchanges rules while that lowers disagreement plus leaves.
/// A profile's segment beyond the fourth counts as a tenth of a leaf. The result does not depend on the number of
/// threads. When stopped early, the tree is the best so far.
/// @throws Error without normals or surfaces, or for an option out of range; Cancelled when stopped before the search.
[[nodiscard]] SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        const SolidOptions& options = {}, const RunContext& run = {});

/// The same with known solids. They are terms of any type, and cost a twentieth of a leaf. New solids may end at
/// their faces. Detected surfaces adapt to them. No surfaces are needed where a known solid has points. `areas` as in
/// label_places().
[[nodiscard]] SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                        std::span<const KnownSolid> known, const SolidOptions& options,
                                        const RunContext& run, std::span<const double> areas = {});

}  // namespace cloud2csg
