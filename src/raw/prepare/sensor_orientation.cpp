#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/parallel.hpp"
#include "raw/prepare/neighbours.hpp"
#include "raw/prepare/orientation.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::size_t k_asked = 12;  ///< neighbours that a point asks
/// Of the angle between normal and line of sight: below, an error of the normal may turn its sign (11 degrees).
constexpr double k_grazing_cosine = 0.2;
/// Shares of the neighbours' weight: with less on one side they are of both sides of a wall, and tell nothing.
constexpr double k_grazing_majority = 0.6;
/// At an edge the plane may be that of the face around the corner, which the sensor saw from behind or not at all.
constexpr double k_clear_majority = 0.9;
constexpr int k_rounds = 3;

/// Cosine between a normal and the way to the sensor; 0 where the two are at one place.
double sight_cosine(const Vector3d& place, const Vector3d& normal, const Vector3d& sensor) {
  const Vector3d way = sensor - place;
  const double length = way.norm();
  return length > 0.0 ? normal.dot(way) / length : 0.0;
}

}  // namespace

std::vector<char> orient_to_sensors(const Points& places, const Points& normals, const Points& sensors,
                                    const NeighbourTable& neighbours, const RunContext& run, const StageShare& share) {
  // How surely each normal is the right way round: its cosine, negative to turn it.
  std::vector<double> signs(places.size());
  std::vector<char> is_grazing(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    signs[i] = sight_cosine(places[i], normals[i], sensors[i]);
    is_grazing[i] = std::abs(signs[i]) < k_grazing_cosine ? 1 : 0;
  }
  const std::size_t links = std::min(k_asked, neighbours.width);
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
      const double majority = is_grazing[i] != 0 ? k_grazing_majority : k_clear_majority;
      if (std::abs(votes) > majority * weight) next[i] = votes / static_cast<double>(links);
    });
    signs = std::move(next);
    share.report(run, (round + 1) / double{k_rounds});
  }
  std::vector<char> flipped(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) flipped[i] = signs[i] < 0.0 ? 1 : 0;
  return flipped;
}

}  // namespace cloud2csg
