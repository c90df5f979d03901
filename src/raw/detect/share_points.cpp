#include "raw/detect/share_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"
#include "raw/prepare/neighbours.hpp"

namespace cloud2csg {
namespace {

/// Points that agree with several surfaces, and their nearest neighbours in the cloud.
struct ContestedPoints {
  static constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::uint32_t> rows = {};  ///< by point: into the table, or none
  NeighbourTable neighbours = {};

  [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t i) const {
    return rows[i] == k_none ? std::span<const std::uint32_t>{} : neighbours.of(rows[i]);
  }
};

ContestedPoints contested_points(const std::vector<GrownSurface>& surfaces, const Points& positions,
                                 const NeighbourTree& tree, const RunContext& run) {
  std::vector<std::uint8_t> claims(positions.size(), 0);
  for (const GrownSurface& surface : surfaces) {
    for (const std::uint32_t i : surface.points) claims[i] = static_cast<std::uint8_t>(std::min(claims[i] + 1, 2));
  }
  ContestedPoints result{.rows = std::vector<std::uint32_t>(positions.size(), ContestedPoints::k_none)};
  std::vector<std::uint32_t> contested;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (claims[i] < 2) continue;
    result.rows[i] = static_cast<std::uint32_t>(contested.size());
    contested.push_back(i);
  }
  result.neighbours = find_neighbours_of(contested, positions, tree, std::min(k_around, positions.size() - 1), run);
  return result;
}

/// By point: the surface on which it and the points around it cost least. Its own cost has no limit.
std::vector<std::size_t> owners_of(const std::vector<GrownSurface>& surfaces,
                                   const std::vector<std::vector<double>>& distances, const ContestedPoints& contested,
                                   double noise) {
  const std::size_t count = contested.rows.size();
  std::vector<std::size_t> owners(count);
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  const double most = cost_of(k_deviations, 1);
  std::vector<double> costs(count, most);  // on one surface
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const std::vector<std::uint32_t>& points = surfaces[k].points;
    for (std::size_t n = 0; n < points.size(); ++n) costs[points[n]] = cost_of(distances[k][n], noise);
    for (std::size_t n = 0; n < points.size(); ++n) {
      double cost = std::pow(distances[k][n] / noise, 2) / 2;
      for (const std::uint32_t j : contested.around(points[n])) cost += costs[j];
      if (cost >= least[points[n]]) continue;
      least[points[n]] = cost;
      owners[points[n]] = k;
    }
    for (const std::uint32_t i : points) costs[i] = most;
  }
  return owners;
}

Points positions_of(const WorkCloud& cloud) {
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0U);
  return cloud.positions_of(all);
}

}  // namespace

std::vector<std::vector<double>> claim_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, const RunContext& run) {
  std::vector<std::vector<double>> distances(surfaces.size());
  for_each_index(surfaces.size(), run, [&](std::size_t k) {
    GrownSurface& surface = surfaces[k];
    surface.points.clear();
    surface.support = 0;
    const auto always = [](std::uint32_t) { return true; };
    for_each_agreeing(surface.surface, cloud, limits.within(surface.reach), always,
                      [&](std::uint32_t i, const Agreement& agreement) {
                        surface.points.push_back(i);
                        surface.support += limits.support(agreement);
                        distances[k].push_back(std::abs(agreement.distance));
                      });
  });
  return distances;
}

PointSharing::PointSharing(const WorkCloud& cloud, const AgreementLimits& limits)
    : cloud_(cloud), limits_(limits), positions_(positions_of(cloud)), tree_(positions_) {}

std::vector<GrownSurface> PointSharing::shared(std::vector<GrownSurface> surfaces, std::size_t least,
                                               const RunContext& run) const {
  const std::vector<std::vector<double>> distances = claim_all(surfaces, cloud_, limits_, run);
  const ContestedPoints contested = contested_points(surfaces, positions_, tree_, run);
  const std::vector<std::size_t> owners = owners_of(surfaces, distances, contested, limits_.noise);
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    std::erase_if(surfaces[k].points, [&](std::uint32_t i) { return owners[i] != k; });
  }
  std::erase_if(surfaces, [&](const GrownSurface& s) { return s.points.size() < least; });
  return surfaces;
}

}  // namespace cloud2csg
