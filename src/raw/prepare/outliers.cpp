#include "raw/prepare/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_isolated_spacings = 6.0;
/// A neighbour counts when its plane explains this share of its own neighbours.
constexpr double k_planar_support = 0.4;
/// Where there are outliers: the best plane of points by chance has so much more than any.
constexpr double k_beyond_chance = 0.25;
constexpr double k_most_support = 0.8;
/// Of the neighbours that count: with so many planes through it a point stays. At a corner of three faces a third does,
/// give or take chance.
constexpr double k_least_agreement = 0.17;
/// The same of a point that looks like an outlier: planes go through it by chance, too.
constexpr double k_suspect_agreement = 0.4;
/// A point this much farther from others than its neighbours are looks like an outlier.
constexpr double k_suspect_gap = 1.4;
constexpr std::size_t k_gap_neighbours = 8;
/// Fewer neighbours that count are no evidence: a wire or a speck has no planes.
constexpr std::size_t k_least_witnesses = 6;

/// Neighbours whose planes tell something.
struct Witnesses {
  std::size_t count = 0;
  std::size_t agreeing = 0;  ///< the point lies on their planes
  double usual_gap = 0.0;    ///< the median of their distances to neighbours of their own
};

double gap_of(const LocalFits& fits, std::size_t point) {
  return fits.neighbours.distances_of(point)[std::min(k_gap_neighbours, fits.neighbours.width) - 1];
}

/// Whether the plane of a point is more than chance.
bool has_plane(const LocalFits& fits, std::size_t point, double noise, Strictness strictness) {
  if (strictness == Strictness::trusting) return fits.planes[point].support >= k_planar_support;
  // Of points all over a ball, a slab through its middle holds this share.
  const double reach = fits.neighbours.distances_of(point).back();
  const double half = std::clamp(k_noise_tolerance * noise / reach, k_bend_tolerance, 1.0);
  const double by_chance = half * (1.5 - 0.5 * half * half);
  return fits.planes[point].support >= std::clamp(by_chance + k_beyond_chance, k_planar_support, k_most_support);
}

Witnesses ask_witnesses(const LocalFits& fits, std::size_t point, double noise, Strictness strictness) {
  Witnesses witnesses;
  std::array<double, k_judges> gaps{};
  for (const std::uint32_t neighbour : fits.neighbours.of(point).first(std::min(k_judges, fits.neighbours.width))) {
    const LocalPlane& plane = fits.planes[neighbour];
    if (!has_plane(fits, neighbour, noise, strictness)) continue;
    gaps[witnesses.count++] = gap_of(fits, neighbour);
    const Vector3d to = fits.points[point] - fits.points[neighbour];
    const double height = std::abs(plane.normal.dot(to) + plane.offset);
    witnesses.agreeing += height <= k_noise_tolerance * noise + k_bend_tolerance * to.norm() ? 1 : 0;
  }
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(witnesses.count / 2);
  std::nth_element(gaps.begin(), middle, gaps.begin() + static_cast<std::ptrdiff_t>(witnesses.count));
  if (witnesses.count > 0) witnesses.usual_gap = *middle;
  return witnesses;
}

/// Whether the planes of enough neighbours go through the point.
bool is_on_surface(const LocalFits& fits, std::size_t point, double noise, Strictness strictness) {
  const Witnesses witnesses = ask_witnesses(fits, point, noise, strictness);
  if (witnesses.count < k_least_witnesses) return has_plane(fits, point, noise, strictness);
  const bool is_suspect =
      strictness == Strictness::suspicious && (gap_of(fits, point) > k_suspect_gap * witnesses.usual_gap ||
                                               2 * witnesses.count < std::min(k_judges, fits.neighbours.width));
  const double least = is_suspect ? k_suspect_agreement : k_least_agreement;
  return static_cast<double>(witnesses.agreeing) >= least * static_cast<double>(witnesses.count);
}

}  // namespace

std::vector<Verdict> judge_points(const LocalFits& fits, const Scale& scale, Strictness strictness,
                                  const RunContext& run, const StageShare& share) {
  const std::size_t count = fits.points.size();
  std::vector<Verdict> verdicts(count, Verdict::stays);
  if (fits.neighbours.width < k_least_witnesses) return verdicts;
  for_each_index_by_chunks(count, k_chunk_points, run, share, [&](std::size_t i) {
    if (is_on_surface(fits, i, scale.noise, strictness)) return;
    const bool is_far = fits.neighbours.distances_of(i)[k_least_witnesses - 1] > k_isolated_spacings * scale.spacing;
    verdicts[i] = is_far ? Verdict::isolated : Verdict::off_surface;
  });
  return verdicts;
}

}  // namespace cloud2csg
