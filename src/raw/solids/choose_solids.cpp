#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/run.hpp"
#include "raw/solids/bare_surface.hpp"
#include "raw/solids/known_parts.hpp"
#include "raw/solids/list_search.hpp"
#include "raw/solids/separators.hpp"
#include "raw/solids/write_solids.hpp"

namespace cloud2csg {
namespace {

constexpr double k_least_tolerance = 1e-3;  // in diagonals
constexpr double k_tolerance_sigmas = 2;

/// The given noise, or else the root mean square of the residuals.
double noise_of(std::span<const DetectedSurface> surfaces, std::span<const KnownSolid> known,
                const SolidOptions& options) {
  if (options.places.noise) return *options.places.noise;
  double squares = 0;
  double points = 0;
  const auto add = [&](std::size_t count, double rms) {
    squares += static_cast<double>(count) * rms * rms;
    points += static_cast<double>(count);
  };
  for (const DetectedSurface& detected : surfaces) add(detected.points.size(), detected.rms);
  for (const KnownSolid& solid : known) add(solid.own.points.size(), solid.own.rms);
  return points > 0 ? std::sqrt(squares / points) : 0.0;
}

double tolerance_of(const PointCloud& cloud, const SolidOptions& options, double noise) {
  return options.regularity.distance_tolerance.value_or(
      std::max(k_tolerance_sigmas * noise, k_least_tolerance * bounds_of(cloud.positions).diagonal().norm()));
}

/// Applies the given values to the found surfaces and regularises them together with those of known solids.
GivenSurfaces made_regular(const PointCloud& cloud, std::span<const DetectedSurface> found,
                           std::span<const DetectedSurface> of_known, const RegularityOptions& options,
                           double tolerance) {
  GivenSurfaces result = take_given_values(cloud, found, options, options.given_tolerance.value_or(tolerance));
  if (!options.snap) return result;
  std::vector<DetectedSurface> all = result.surfaces;
  all.insert(all.end(), of_known.begin(), of_known.end());
  std::vector<FixedValues> fixed = result.fixed;
  fixed.resize(all.size(), {.direction = true, .position = true, .radius = true});
  RegularSurfaces regular = regularise(all, tolerance, options.angle_tolerance_deg, fixed, cloud.positions);
  regular.surfaces.resize(found.size());
  result.surfaces = std::move(regular.surfaces);
  result.snaps.insert(result.snaps.end(), regular.snaps.begin(), regular.snaps.end());
  return result;
}

/// The cloud with the points of surfaces moved onto them, and with their normals. A surface is known much better than
/// one of its points, so the two sides of a wall may be nearer than three standard deviations of the noise. Takes the
/// surfaces as found: made regular, the sides of a thin wall may be one plane.
PointCloud moved_onto(PointCloud cloud, std::span<const DetectedSurface> surfaces) {
  if (!cloud.has_normals()) return cloud;  // label_places() refuses it
  for (const DetectedSurface& detected : surfaces) {
    for (const std::uint32_t i : detected.points) {
      const Eigen::Vector3d position = cloud.positions[i];
      const Eigen::Vector3d outward = normal(detected.surface, position);
      cloud.positions.set(i, position - signed_distance(detected.surface, position) * outward);
      cloud.normals.set(i, outward);
    }
  }
  return cloud;
}

/// Places that judge a list: those of the cloud, and those beside bare surface of the solids that were tried.
class Judges {
 public:
  explicit Judges(LabelledPlaces of_cloud) : of_cloud_(of_cloud), all_(std::move(of_cloud)) {}

  [[nodiscard]] const LabelledPlaces& all() const { return all_; }

  /// Adds places beside the solid's bare surface if the wrong ones weigh a leaf. @returns the number of new ones
  std::size_t learn_from(const WrittenSolids& written, const Points& points, double near, double leaf,
                         const RunContext& run) {
    constexpr double k_depth = 1e-3;  // in diagonals, as the least depth of places beside points
    const BareSurface bare = find_bare_surface(written.tree, written.solids, points, near, run);
    const LabelledPlaces beside = places_beside(bare, of_cloud_, k_depth * bounds_of(points).diagonal().norm());
    if (wrong_place_share(written.tree, written.solids, beside) < leaf) return 0;
    const std::size_t before = all_.weights.size();
    for (std::size_t i = 0; i < beside.weights.size(); ++i) {
      const Eigen::Vector3d place = beside.positions[i];
      if (!known_.insert({place.x(), place.y(), place.z()}).second) continue;
      all_.positions.push_back(place);
      all_.weights.push_back(beside.weights[i]);
    }
    return all_.weights.size() - before;
  }

 private:
  LabelledPlaces of_cloud_, all_;
  std::set<std::array<double, 3>> known_ = {};  ///< a solid that stays as it is has the same samples in each round
};

struct FoundList {
  LabelledPlaces places = {};  ///< that judged the list
  DecisionList list = {};
  WrittenSolids written = {};
  std::vector<ChoiceRound> rounds = {};
};

/// The round that has led to this tree.
ChoiceRound round_of(const WrittenSolids& written, const LabelledPlaces& places, std::size_t new_planes,
                     std::size_t new_places) {
  return {.planes = new_planes,
          .places = new_places,
          .leaves = leaf_count(written.tree),
          .disagreement = wrong_place_share(written.tree, written.solids, places)};
}

/// Searches a list, then improves it while that saves anything: with planes between the solid and lumps that are
/// wrongly in it, and with places beside surface that no point is near. All rounds together work no longer than the
/// search. `families` is a space without places.
FoundList found_list(const TermSpace& families, LabelledPlaces places, const Points& points, double near,
                     const TermCosts& costs, ListLimits limits, const RunContext& run) {
  constexpr int k_rounds = 4;  // each mends what the last one left
  Judges judges(std::move(places));
  const TermSpace space = with_places(families, judges.all());
  FoundList found{.list = search_list(space, costs, limits, run)};
  found.written = write_solids(space, found.list);
  found.rounds.push_back(round_of(found.written, judges.all(), 0, 0));
  limits.work /= k_rounds;
  std::vector<Surface> separators;
  for (int round = 0; round < k_rounds; ++round) {
    const std::vector<Surface> planes = separating_planes(found.written, judges.all(), 2 * costs.leaf, run);
    if (run.stop.stop_requested()) break;
    const std::size_t learned = judges.learn_from(found.written, points, near, costs.leaf, without_stop(run));
    if (planes.empty() && learned == 0) break;
    separators.insert(separators.end(), planes.begin(), planes.end());
    const TermSpace more = with_places(families, judges.all(), separators);
    std::optional<DecisionList> list = improve_list(found.list, more, costs, limits, run);
    if (!list) break;
    found.written = write_solids(more, *list);
    found.list = std::move(*list);
    found.rounds.push_back(round_of(found.written, judges.all(), planes.size(), learned));
  }
  found.places = judges.all();
  return found;
}

}  // namespace

SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                          const SolidOptions& options, const RunContext& run) {
  return choose_solids(cloud, surfaces, {}, options, run);
}

SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                          std::span<const KnownSolid> known, const SolidOptions& options, const RunContext& run,
                          std::span<const double> areas) {
  validate(options);
  const bool is_any_seen =
      std::ranges::any_of(known, [](const KnownSolid& solid) { return !solid.own.points.empty(); });
  if (surfaces.empty() && !is_any_seen) {
    throw Error({.where = "surfaces", .expected = "expected at least one surface, found none"});
  }
  PlaceOptions place_options = options.places;
  place_options.noise = noise_of(surfaces, known, options);
  place_options.volume_places =
      std::max(place_options.volume_places, options.volume_places_a_surface * surfaces.size());
  place_options.surface_points =
      std::max(place_options.surface_points, options.surface_points_a_surface * surfaces.size());
  const double tolerance = tolerance_of(cloud, options, *place_options.noise);
  KnownTerms terms{.solids = {}, .surfaces = surfaces_of_known(cloud, known)};
  for (const KnownSolid& one : known) terms.solids.push_back(one.solid);
  GivenSurfaces regular = made_regular(cloud, surfaces, terms.surfaces, options.regularity, tolerance);
  run.throw_if_stopped();
  SolidChoice choice;
  const ListLimits limits{.rules = options.most_rules};
  const std::vector<double> own_areas = areas.empty() ? point_areas(cloud, run) : std::vector<double>();
  if (areas.empty()) areas = own_areas;
  LabelledPlaces of_cloud = label_places(moved_onto(cloud, surfaces), place_options, run, areas);
  const double spacing = spacing_of({areas.begin(), areas.end()});
  const TermSpace families =
      make_term_space(cloud.positions, regular.surfaces, {.tolerance = tolerance, .spacing = spacing}, terms);
  auto [places, list, written, rounds] =
      found_list(families, std::move(of_cloud), cloud.positions, bare_distance(spacing, tolerance),
                 {.leaf = options.leaf_cost}, limits, run);
  if (known.empty()) {  // known solids stay as they are
    written = without_what_sticks_out(std::move(written), families.part_bounds, cloud.positions, tolerance,
                                      without_stop(run));
  }
  choice.places = std::move(places);
  choice.solids = std::move(written.solids);
  choice.tree = std::move(written.tree);
  choice.disagreement = wrong_place_share(choice.tree, choice.solids, choice.places);
  choice.rounds = std::move(rounds);
  choice.snaps = std::move(regular.snaps);
  choice.warnings = std::move(regular.warnings);
  if (list.size() >= options.most_rules) {
    choice.warnings.push_back(
        fmt::format("the solid has more than {} parts: the smallest parts are left out", options.most_rules));
  }
  return choice;
}

}  // namespace cloud2csg
