#include "raw/detect/two_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "raw/detect/propose.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Sides = std::array<std::vector<std::uint32_t>, 2>;  // points of each surface

/// Median of the run of successive distances that is likeliest to be off 0, of runs of all powers of two. 0 if none
/// shows half of the evidence, after the chance that one of the runs of its width does: this is a cheap first look, and
/// most surfaces end here. The other half of the evidence may lie in other runs.
double strongest_offset(const std::vector<double>& distances, double noise) {
  const double most = 10 * noise;  // a single outlier is no step
  std::vector<double> sums{0};
  for (const double d : distances) sums.push_back(sums.back() + std::clamp(d, -most, most));
  double best = k_evidence / 2;
  std::vector<double> strongest;
  for (std::size_t width = 2 * k_nearest; width <= distances.size(); width *= 2) {
    const auto count = static_cast<double>(width);
    const double by_chance = std::log(2 * static_cast<double>(distances.size()) / count);
    for (std::size_t first = 0; first + width <= distances.size(); first += width / 2) {
      const double deviation = (sums[first + width] - sums[first]) / noise;
      const double gain = deviation * deviation / (2 * count) - by_chance;
      if (gain <= best) continue;
      best = gain;
      const auto begin = distances.begin() + static_cast<std::ptrdiff_t>(first);
      strongest.assign(begin, begin + static_cast<std::ptrdiff_t>(width));
    }
  }
  return strongest.empty() ? 0 : median_of(strongest);
}

/// How many neighbours decide the side of a point: k_nearest for a step of two standard deviations. Their evidence
/// grows with the square of the height, so a lower step needs more. With half of the limit, fewer steps of one standard
/// deviation are found; double costs more time than the fits.
std::size_t neighbours_for(double deviations) {
  constexpr double k_most = 8;
  return static_cast<std::size_t>(k_nearest * std::clamp(4 / (deviations * deviations), 1.0, k_most));
}

/// Puts each point on the side that its neighbours are likelier to be on. `prior`: how much likelier side 0 is.
void choose_sides(TwoSurfaces& two, const NearPoints& near, std::size_t around, double prior, const RunContext& run) {
  std::vector<double> votes(near.points.size());  // for side 1
  for (std::size_t k = 0; k < votes.size(); ++k) {
    votes[k] = cost_of(two.distances[0][k], near.noise) - cost_of(two.distances[1][k], near.noise);
  }
  for_each_index_by_chunks(votes.size(), k_chunk_points, run, [&](std::size_t k) {
    double sum = -prior;
    for (const std::uint32_t j : near.neighbours.nearest(k, around)) sum += votes[j];
    two.side[k] = sum > 0 ? 1 : 0;
  });
}

/// Points of each side that are clear of the other.
Sides clear_points(const TwoSurfaces& two, const NearPoints& near) {
  Sides clear;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (share_on_own_side(two, near, k) >= k_clear_share) clear[two.side[k]].push_back(near.points[k]);
  }
  return clear;
}

/// The one surface, and the same at the height of the strongest run; all points are on the first side.
TwoSurfaces start_from_run(const Surface& one, const NearPoints& near) {
  TwoSurfaces two{.surfaces = {one, one},
                  .distances = {near.distances, near.distances},
                  .side = std::vector<std::uint8_t>(near.points.size(), 0)};
  for (double& d : two.distances[1]) d -= near.offset;
  return two;
}

/// Whether most of the points have about the surface's normals. Else the surface may cross points that are as noisy as
/// it is wide.
bool has_normals_of(const Surface& surface, const std::vector<std::uint32_t>& points, const NearPoints& near) {
  const AgreementLimits by_normal = near.fit_limits.within(std::numeric_limits<double>::infinity());
  const std::vector<OrientedPoint> some = near.cloud.some_of(points, k_sample);
  return 2 * count_agreeing(surface, some, by_normal) > some.size();
}

/// Each of the two, fitted to its points.
std::optional<TwoSurfaces> with_fits_to(const Sides& points, TwoSurfaces two, const NearPoints& near) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (points[side].empty()) return std::nullopt;
    const auto fitted = fit_plausible(two.surfaces[side], near.cloud, points[side], near.fit_limits);
    if (!fitted || !has_normals_of(*fitted, points[side], near)) return std::nullopt;
    two.surfaces[side] = *fitted;
    two.distances[side] = distances_of(*fitted, near.cloud, near.points);
  }
  return two;
}

/// The points of the patches [first, last).
std::span<const std::uint32_t> patch_points(const NearPoints& near, std::size_t first, std::size_t last) {
  return std::span(near.points).subspan(first * k_patch, (last - first) * k_patch);
}

/// A surface of some patches. Others on one side of it are on a second one, about parallel to it.
struct PatchSides {
  Surface surface;
  std::vector<double> deviations;  ///< of the mean of each patch, in standard errors
  double height = 0;               ///< of the second surface, in standard errors; 0: there is none
  double cost = 0;

  [[nodiscard]] bool is_on_second(std::size_t patch) const {
    return cost_of(deviations[patch] - height, 1) < cost_of(deviations[patch], 1);
  }
};

/// Median of the largest group of values no farther apart than noise makes them; 0 without values. Patches across a
/// high step are anywhere between its sides.
double middle_of_most(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  std::size_t most = 0;
  std::size_t start = 0;
  for (std::size_t first = 0, end = 0; first < values.size(); ++first) {
    while (end < values.size() && values[end] - values[first] <= 2 * k_deviations) ++end;
    if (end - first <= most) continue;
    most = end - first;
    start = first;
  }
  return values[start + most / 2];
}

PatchSides sides_of(const Surface& surface, const NearPoints& near) {
  PatchSides sides{.surface = surface, .deviations = {}};
  const std::vector<double> distances = distances_of(surface, near.cloud, near.points);
  std::vector<double> off;  // of the patches that are clearly off
  for (std::size_t p = 0; p < near.points.size() / k_patch; ++p) {
    const auto patch = std::span(distances).subspan(p * k_patch, k_patch);
    const double deviation = std::reduce(patch.begin(), patch.end()) / (near.noise * std::sqrt(k_patch));
    sides.deviations.push_back(deviation);
    if (std::abs(deviation) > k_deviations) off.push_back(deviation);
  }
  sides.height = middle_of_most(std::move(off));
  for (const double d : sides.deviations) sides.cost += std::min(cost_of(d, 1), cost_of(d - sides.height, 1));
  return sides;
}

/// Fits the one surface to windows of a half to an eighth of the patches, and takes the fit that explains all patches
/// best together with a second surface. The two halves of a face need this start: the one surface is tilted between
/// them.
std::optional<TwoSurfaces> start_from_patches(const Surface& one, const NearPoints& near) {
  const std::size_t count = near.points.size() / k_patch;
  PatchSides best = sides_of(one, near);
  for (std::size_t width = count / 2; width > 0 && width >= count / 8; width /= 2) {
    for (std::size_t first = 0; first + width <= count; first += (width + 1) / 2) {
      const std::vector<OrientedPoint> points = near.cloud.some_of(patch_points(near, first, first + width), k_sample);
      const std::optional<Surface> fitted = fit_plausible(one, points, near.fit_limits);
      if (!fitted) continue;
      PatchSides sides = sides_of(*fitted, near);
      if (sides.cost < best.cost) best = std::move(sides);
    }
  }
  Sides points;
  for (std::size_t p = 0; p < best.deviations.size(); ++p) {
    std::ranges::copy(patch_points(near, p, p + 1), std::back_inserter(points[best.is_on_second(p) ? 1 : 0]));
  }
  TwoSurfaces two = start_from_run(one, near);
  two.surfaces.fill(best.surface);
  return with_fits_to(points, std::move(two), near);
}

/// Median height of the second surface over the first in standard deviations, where its points are.
double height_of(const TwoSurfaces& two, const NearPoints& near) {
  std::vector<double> heights;
  for (std::size_t k = 0; k < near.points.size(); ++k) {
    if (two.side[k] == 0) continue;
    heights.push_back(std::abs(two.distances[0][k] - two.distances[1][k]) / near.noise);
  }
  return median_of(heights);
}

/// Alternates between choosing sides and fitting (classification EM: Celeux and Govaert 1992).
std::optional<TwoSurfaces> alternate(std::optional<TwoSurfaces> two, const NearPoints& near, const RunContext& run) {
  std::size_t around = neighbours_for(near.offset / near.noise);
  double prior = 0;
  std::vector<std::uint8_t> before;
  for (int round = 0; round < 2 * k_rounds && two && two->side != before; ++round) {
    before = two->side;
    choose_sides(*two, near, around, prior, run);
    const Sides clear = clear_points(*two, near);
    two = with_fits_to(clear, std::move(*two), near);
    if (!two) break;
    prior = std::log(static_cast<double>(clear[0].size()) / static_cast<double>(clear[1].size()));
    around = neighbours_for(height_of(*two, near));
  }
  return two;
}

}  // namespace

std::optional<NearPoints> near_points(const GrownSurface& grown, const WorkCloud& cloud,
                                      const std::vector<bool>& is_free, const SearchLimits& limits,
                                      const RunContext& run) {
  const double usual = limits.agreement.noise;
  const double noise =
      std::max(usual, noise_within_patches(distances_of(grown.surface, cloud, grown.points)).value_or(usual));
  if (grown.surface.type != SurfaceType::plane && usual < k_clear_share * noise) return std::nullopt;
  AgreementLimits wide = limits.agreement;
  wide.distance *= 3;  // a step within could hide in the limits
  std::vector<std::uint32_t> points = points_near(grown, cloud, wide, [&](std::uint32_t i) { return is_free[i]; });
  if (points.size() < 2 * limits.least_points) return std::nullopt;
  std::vector<double> distances = distances_of(grown.surface, cloud, points);
  const double offset = strongest_offset(distances, noise);
  // Halves of a face that are one standard deviation apart are on average a quarter off a tilted surface. Much lower
  // steps, the neighbours cannot tell.
  constexpr double k_least_offset = 0.15;
  if (std::abs(offset) < k_least_offset * noise) return std::nullopt;
  // Neighbours in space would have similar errors where the noise is more than the spacing.
  Points feet = cloud.positions_of(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    feet.set(k, feet[k] - signed_distance(grown.surface, feet[k]) * normal(grown.surface, feet[k]));
  }
  const std::size_t around = std::max(k_around, neighbours_for(offset / noise));
  NeighbourTable neighbours = find_neighbours(feet, NeighbourTree(feet), around, run);
  return NearPoints{.cloud = cloud,
                    .points = std::move(points),
                    .distances = std::move(distances),
                    .offset = offset,
                    .feet = std::move(feet),
                    .neighbours = std::move(neighbours),
                    .noise = noise,
                    .fit_limits = limits.agreement.within(std::min(k_deviations * noise, limits.agreement.distance))};
}

double share_on_own_side(const TwoSurfaces& two, const NearPoints& near, std::size_t k) {
  const std::span<const std::uint32_t> around = near.neighbours.nearest(k, k_around);
  const auto same = std::ranges::count_if(around, [&](std::uint32_t j) { return two.side[j] == two.side[k]; });
  return static_cast<double>(same) / static_cast<double>(around.size());
}

double cost_of(const TwoSurfaces& two, const NearPoints& near) {
  double cost = 0;
  for (std::size_t k = 0; k < near.points.size(); ++k) cost += cost_of(two.distance(k), near.noise);
  return cost;
}

std::optional<TwoSurfaces> fit_two(const Surface& one, const NearPoints& near, const RunContext& run) {
  // A small part begins at its height over the rest.
  std::optional<TwoSurfaces> two = alternate(start_from_run(one, near), near, run);
  std::optional<TwoSurfaces> of_patches = alternate(start_from_patches(one, near), near, run);
  if (!two || (of_patches && cost_of(*of_patches, near) < cost_of(*two, near))) two = std::move(of_patches);
  if (two && 2 * std::ranges::count(two->side, std::uint8_t{1}) > std::ssize(two->side)) {
    std::swap(two->surfaces[0], two->surfaces[1]);
    std::swap(two->distances[0], two->distances[1]);
    for (std::uint8_t& side : two->side) side ^= 1;
  }
  return two;
}

}  // namespace cloud2csg
