#include "raw/detect/share_points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/base/parallel.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

/// By point: whether it agrees with several surfaces.
std::vector<bool> contested_points(const std::vector<GrownSurface>& surfaces, std::size_t points) {
  std::vector<bool> is_claimed(points, false);
  std::vector<bool> is_contested(points, false);
  for (const GrownSurface& surface : surfaces) {
    for (const std::uint32_t i : surface.points) {
      if (is_claimed[i]) is_contested[i] = true;
      is_claimed[i] = true;
    }
  }
  return is_contested;
}

/// By point: the surface on which it and the points around it cost least. Its own cost has no limit.
std::vector<std::size_t> owners_of(const std::vector<GrownSurface>& surfaces,
                                   const std::vector<std::vector<double>>& distances, const NeighbourTable& neighbours,
                                   std::size_t count, double noise) {
  const std::vector<bool> is_contested = contested_points(surfaces, count);
  std::vector<std::size_t> owners(count);
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  const double most = cost_of(k_deviations, 1);
  std::vector<double> costs(count, most);  // on one surface
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const std::vector<std::uint32_t>& points = surfaces[k].points;
    for (std::size_t n = 0; n < points.size(); ++n) costs[points[n]] = cost_of(distances[k][n], noise);
    for (std::size_t n = 0; n < points.size(); ++n) {
      double cost = std::pow(distances[k][n] / noise, 2) / 2;
      if (is_contested[points[n]]) {
        for (const std::uint32_t j : neighbours.of(points[n])) cost += costs[j];
      }
      if (cost >= least[points[n]]) continue;
      least[points[n]] = cost;
      owners[points[n]] = k;
    }
    for (const std::uint32_t i : points) costs[i] = most;
  }
  return owners;
}

}  // namespace

std::vector<std::vector<double>> claim_all(std::vector<GrownSurface>& surfaces, const WorkCloud& cloud,
                                           const AgreementLimits& limits, const RunContext& run) {
  std::vector<std::vector<double>> distances(surfaces.size());
  for_each_index(surfaces.size(), run, [&](std::size_t k) {
    GrownSurface& surface = surfaces[k];
    surface.points.clear();
    const auto always = [](std::uint32_t) { return true; };
    for_each_agreeing(surface.surface, cloud, limits.within(surface.reach), always,
                      [&](std::uint32_t i, const Agreement& agreement) {
                        surface.points.push_back(i);
                        distances[k].push_back(std::abs(agreement.distance));
                      });
  });
  return distances;
}

std::vector<GrownSurface> share_points(std::vector<GrownSurface> surfaces, const WorkCloud& cloud,
                                       const NeighbourTable& neighbours, const AgreementLimits& limits,
                                       std::size_t least, const RunContext& run) {
  const std::vector<std::vector<double>> distances = claim_all(surfaces, cloud, limits, run);
  const std::vector<std::size_t> owners = owners_of(surfaces, distances, neighbours, cloud.size(), limits.noise);
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    std::erase_if(surfaces[k].points, [&](std::uint32_t i) { return owners[i] != k; });
  }
  std::erase_if(surfaces, [&](const GrownSurface& s) { return s.points.size() < least; });
  return surfaces;
}

}  // namespace cloud2csg
