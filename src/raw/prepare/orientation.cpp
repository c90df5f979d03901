#include "raw/prepare/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/neighbours.hpp"
#include "raw/prepare/patches.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Few enough to consider all pairs. Patches have so many points that there would be half as many of them, and are
/// smaller than details.
constexpr std::size_t k_most_patches = 4096;
/// A winding number this far from one half contradicts the orientation.
constexpr double k_doubt = 0.35;

struct Cloud {
  const Points& places;
  const Points& normals;
  const NeighbourTable& neighbours;
  const std::vector<double>& areas;

  [[nodiscard]] std::size_t size() const { return places.size(); }
  [[nodiscard]] std::span<const std::uint32_t> linked(std::size_t i) const { return neighbours.nearest(i, k_voters); }
  /// Cubed, so that certain votes outweigh many vague ones.
  [[nodiscard]] double vote(std::size_t i, std::size_t j) const {
    const double vote = agreement(places[j] - places[i], normals[i], normals[j]);
    return vote * vote * vote;
  }
};

std::vector<PatchVote> votes_between(const Cloud& cloud, const Patches& patches) {
  std::vector<PatchVote> links;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const std::uint32_t own = patches.of_point[i];
    if (own == Patches::k_none) continue;
    for (const std::uint32_t j : cloud.linked(i)) {
      const std::uint32_t other = patches.of_point[j];
      if (other == Patches::k_none || other == own) continue;
      const double vote = cloud.vote(i, j) * (patches.flipped[i] == patches.flipped[j] ? 1.0 : -1.0);
      links.push_back({std::min(own, other), std::max(own, other), vote});
    }
  }
  const auto key = [](const PatchVote& vote) { return std::pair(vote.one, vote.other); };
  std::stable_sort(links.begin(), links.end(), [&](const PatchVote& a, const PatchVote& b) { return key(a) < key(b); });
  std::vector<PatchVote> sums;
  for (const PatchVote& link : links) {
    if (!sums.empty() && key(sums.back()) == key(link)) {
      sums.back().votes += link.votes;
    } else {
      sums.push_back(link);
    }
  }
  return sums;
}

struct Dipole {
  Vector3d place;
  Vector3d strength;  ///< normal x area / 4 pi
  double smoothing;   ///< square of the radius of its disc

  [[nodiscard]] double at(const Vector3d& where) const {
    const Vector3d to = place - where;
    const double square = std::max(to.squaredNorm(), smoothing);
    return square > 0.0 ? strength.dot(to) / (square * std::sqrt(square)) : 0.0;
  }
};

/// The dipoles of a patch, and their sum for distant places.
struct PatchSource {
  std::vector<Dipole> dipoles;
  Dipole all = {Vector3d::Zero(), Vector3d::Zero(), 0.0};
  double near_square = 0.0;

  [[nodiscard]] double at(const Vector3d& where) const {
    if ((where - all.place).squaredNorm() > near_square) return all.at(where);
    double sum = 0.0;
    for (const Dipole& dipole : dipoles) sum += dipole.at(where);
    return sum;
  }
};

PatchSource source_of(const Cloud& cloud, const Patches& patches, std::span<const std::uint32_t> points) {
  PatchSource source;
  for (const std::uint32_t i : points) {
    const double sign = patches.flipped[i] != 0 ? -1.0 : 1.0;
    source.dipoles.push_back({cloud.places[i], sign * cloud.areas[i] / (4.0 * std::numbers::pi) * cloud.normals[i],
                              cloud.areas[i] / std::numbers::pi});
    source.all.place += cloud.places[i] / static_cast<double>(points.size());
    source.all.strength += source.dipoles.back().strength;
  }
  for (const Dipole& dipole : source.dipoles) {
    source.near_square =
        std::max(source.near_square, k_far_radii * k_far_radii * (dipole.place - source.all.place).squaredNorm());
  }
  return source;
}

/// The field of each patch at the middles of all. A patch has no field at its own middle, which lies in its plane.
PatchFields fields_of(const Cloud& cloud, const Patches& patches, const RunContext& run, const StageShare& share) {
  std::vector<PatchSource> sources;
  for (const std::vector<std::uint32_t>& points : patches.points) {
    sources.push_back(source_of(cloud, patches, points));
  }
  const std::size_t count = sources.size();
  PatchFields fields{.count = count, .values = std::vector<float>(count * count, 0.0F)};
  for_each_index_by_chunks(count, 1, run, share, [&](std::size_t source) {
    for (std::size_t i = 0; i < count; ++i) {
      if (i != source) fields.values[source * count + i] = static_cast<float>(sources[source].at(sources[i].all.place));
    }
  });
  return fields;
}

/// The patches with the most points, limited by the cost of all pairs.
Patches largest_of(Patches patches) {
  if (patches.points.size() <= k_most_patches) return patches;
  std::stable_sort(patches.points.begin(), patches.points.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  patches.points.resize(k_most_patches);
  std::fill(patches.of_point.begin(), patches.of_point.end(), Patches::k_none);
  for (std::uint32_t patch = 0; patch < patches.points.size(); ++patch) {
    for (const std::uint32_t i : patches.points[patch]) patches.of_point[i] = patch;
  }
  return patches;
}

double neighbours_votes(const Cloud& cloud, std::uint32_t i, const std::vector<char>& flipped,
                        const std::vector<char>& is_known) {
  double votes = 0.0;
  for (const std::uint32_t j : cloud.linked(i)) {
    if (is_known[j] != 0) votes += cloud.vote(i, j) * (flipped[i] == flipped[j] ? 1.0 : -1.0);
  }
  return votes;
}

/// Points outside all patches follow their neighbours, the closest to a patch first. Each round reaches further.
void spread(const Cloud& cloud, std::vector<char>& flipped, std::vector<char>& is_known) {
  for (int round = 0; round < 2 * k_rounds; ++round) {
    std::vector<char> next = flipped;
    std::vector<char> known_next = is_known;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      if (is_known[i] != 0) continue;
      const double votes = neighbours_votes(cloud, i, flipped, is_known);
      if (votes == 0.0) continue;
      if (votes < 0.0) next[i] ^= 1;
      known_next[i] = 1;
    }
    if (known_next == is_known) return;
    flipped = std::move(next);
    is_known = std::move(known_next);
  }
}

/// Flips points whose neighbours outvote them, such as single points at edges without a local plane.
void sweep(const Cloud& cloud, std::vector<char>& flipped) {
  const std::vector<char> all(cloud.size(), 1);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<char> next = flipped;
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      if (neighbours_votes(cloud, i, flipped, all) < 0.0) next[i] ^= 1;
    }
    if (next == flipped) return;
    flipped = std::move(next);
  }
}

std::size_t count_bodies(const Patches& patches, const PatchSigns& signs, std::size_t points) {
  std::map<std::uint32_t, std::size_t> sizes;
  for (std::size_t patch = 0; patch < patches.points.size(); ++patch) {
    sizes[signs.body_of[patch]] += patches.points[patch].size();
  }
  const double least = k_negligible_share * static_cast<double>(points);
  return static_cast<std::size_t>(std::count_if(
      sizes.begin(), sizes.end(), [&](const auto& body) { return static_cast<double>(body.second) >= least; }));
}

using Eigen::Vector3d;

/// Cosine between a normal and the direction to the sensor; 0 if sensor and place coincide.
double sight_cosine(const Vector3d& place, const Vector3d& normal, const Vector3d& sensor) {
  const Vector3d way = sensor - place;
  const double length = way.norm();
  return length > 0.0 ? normal.dot(way) / length : 0.0;
}

}  // namespace

double agreement(const Vector3d& step, const Vector3d& normal, const Vector3d& other_normal) {
  const double square = step.squaredNorm();
  const double cosine = normal.dot(other_normal);
  if (!(square > 0.0)) return cosine;
  return cosine - 2.0 * normal.dot(step) * other_normal.dot(step) / square;
}

Orientation find_orientation(const Points& places, const Points& normals, const NeighbourTable& neighbours,
                             const std::vector<double>& areas, double noise, const RunContext& run,
                             const StageShare& share) {
  const Cloud cloud{places, normals, neighbours, areas};
  const std::size_t most = std::max(2 * k_nearest, cloud.size() / (k_most_patches / 2));
  const Patches patches = largest_of(grow_patches(places, normals, neighbours, noise, k_nearest, most));
  run.throw_if_stopped();
  std::vector<double> weights;
  for (const std::vector<std::uint32_t>& points : patches.points) {
    weights.push_back(static_cast<double>(points.size()));
  }
  const PatchSigns signs =
      find_patch_signs(fields_of(cloud, patches, run, share), weights, votes_between(cloud, patches), run);
  Orientation result{.flipped = patches.flipped,
                     .is_doubtful = std::vector<char>(cloud.size(), 0),
                     .bodies = count_bodies(patches, signs, cloud.size())};
  std::vector<char> is_known(cloud.size(), 0);
  for (std::size_t patch = 0; patch < patches.points.size(); ++patch) {
    const bool is_doubtful = std::abs(signs.windings[patch] - 0.5) > k_doubt;
    for (const std::uint32_t i : patches.points[patch]) {
      result.flipped[i] ^= signs.flipped[patch];
      result.is_doubtful[i] = is_doubtful ? 1 : 0;
      is_known[i] = 1;
    }
  }
  spread(cloud, result.flipped, is_known);
  sweep(cloud, result.flipped);
  return result;
}

std::vector<char> orient_to_sensors(const Points& places, const Points& normals, const Points& sensors,
                                    const NeighbourTable& neighbours, const RunContext& run, const StageShare& share) {
  // Confidence in each normal: its cosine to the sensor, negative to flip.
  std::vector<double> signs(places.size());
  std::vector<char> is_grazing(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    signs[i] = sight_cosine(places[i], normals[i], sensors[i]);
    // There, an error of the normal may flip its sign.
    is_grazing[i] = std::abs(signs[i]) < k_steep_sine ? 1 : 0;
  }
  const std::size_t links = std::min(k_voters, neighbours.width);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<double> next = signs;
    for_each_index_by_chunks(places.size(), k_chunk_points, run, [&](std::size_t i) {
      double votes = 0.0;
      double weight = 0.0;
      for (const std::uint32_t j : neighbours.of(i).first(links)) {
        const double vote = agreement(places[j] - places[i], normals[i], normals[j]);
        votes += vote * vote * vote * signs[j];
        weight += std::abs(vote * vote * vote * signs[j]);
      }
      // With less, neighbours are on both sides of a wall and tell nothing. At an edge the plane may belong to the
      // adjacent face, which the sensor saw from behind or not at all.
      const double majority = is_grazing[i] != 0 ? k_clear_share : k_nearly_all;
      if (std::abs(votes) > majority * weight) next[i] = votes / static_cast<double>(links);
    });
    signs = std::move(next);
    share.report(run, (round + 1.0) / k_rounds);
  }
  std::vector<char> flipped(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) flipped[i] = signs[i] < 0.0 ? 1 : 0;
  return flipped;
}

}  // namespace cloud2csg
