#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/solids.hpp"
#include "solids/list_search.hpp"
#include "solids/write_solids.hpp"

namespace cloud2csg {
namespace {

constexpr double k_least_tolerance = 1e-3;  // of the diagonal
constexpr double k_tolerance_sigmas = 2;

void require_positive(const std::string& field, double value) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error({.file = {},
               .where = field,
               .expected = fmt::format("expected a finite number above 0, got {}", value),
               .remedy = {}});
}

/// The noise that was given, or else the root mean square of the surfaces' residuals.
double noise_of(std::span<const DetectedSurface> surfaces, const SolidOptions& options) {
  if (options.places.noise) return *options.places.noise;
  double squares = 0;
  double points = 0;
  for (const DetectedSurface& detected : surfaces) {
    const auto count = static_cast<double>(detected.points.size());
    squares += count * detected.rms * detected.rms;
    points += count;
  }
  return points > 0 ? std::sqrt(squares / points) : 0.0;
}

}  // namespace

void validate(const SolidOptions& options) {
  require_positive("leaf_cost", options.leaf_cost);
  require_positive("plane_cost", options.plane_cost);
  require_positive("most_rules", static_cast<double>(options.most_rules));
  require_positive("angle_tolerance_deg", options.regularity.angle_tolerance_deg);
  if (options.regularity.distance_tolerance) {
    require_positive("distance_tolerance", *options.regularity.distance_tolerance);
  }
}

SolidChoice choose_solids(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                          const SolidOptions& options, const RunContext& run) {
  validate(options);
  if (surfaces.empty()) {
    throw Error({.file = {}, .where = "surfaces", .expected = "expected a surface or more, got none", .remedy = {}});
  }
  PlaceOptions place_options = options.places;
  place_options.noise = noise_of(surfaces, options);
  SolidChoice choice;
  choice.places = label_places(cloud, place_options, run);
  const double tolerance = options.regularity.distance_tolerance.value_or(std::max(
      k_tolerance_sigmas * *place_options.noise, k_least_tolerance * bounds_of(cloud.positions).diagonal().norm()));
  RegularSurfaces regular{.surfaces = {surfaces.begin(), surfaces.end()}, .snaps = {}};
  if (options.regularity.snap) {
    regular = regularise(surfaces, tolerance, options.regularity.angle_tolerance_deg);
  }
  run.throw_if_stopped();
  const TermSpace space = make_term_space(cloud, regular.surfaces, choice.places, tolerance);
  const TermCosts costs{.leaf = options.leaf_cost, .plane = options.plane_cost};
  WrittenSolids written = write_solids(space, search_list(space, costs, options.most_rules, run));
  choice.solids = std::move(written.solids);
  choice.tree = std::move(written.tree);
  choice.disagreement = disagreement(choice.tree, choice.solids, choice.places);
  choice.snaps = std::move(regular.snaps);
  return choice;
}

}  // namespace cloud2csg
