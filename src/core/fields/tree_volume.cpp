#include "core/fields/tree_volume.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/fields/bounded_field.hpp"
#include "core/fields/lipschitz.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/octree.hpp"

namespace cloud2csg {
namespace {

/// The user does not choose the seed, because the error says how much the choice of points matters.
constexpr std::uint64_t k_seed = 1;
constexpr int k_most_levels_of_expressions = 6;
constexpr std::size_t k_chunk = 1024;

class Sampler {
 public:
  Sampler(const Model& model, const RunContext& run)
      : field_(bounded_field(model)), steepness_(lipschitz_bound(tree_of(model), model.primitives)), run_(run) {}

  VolumeEstimate estimate(const AlignedBox& box, int levels) {
    const bool is_known = std::isfinite(steepness_);
    if (!is_known) levels = std::min(levels, k_most_levels_of_expressions);
    OctreeLevel cells = lattice(box, Eigen::Vector3i::Ones());
    for (int level = 0; level < levels; ++level) {
      if (level > 0) cells = octants(cells);
      if (is_known) drop_decided(cells);
    }
    const auto [hits, deviants] = judge_octants(cells);
    // With two points an octant, their mean varies by a quarter of their squared difference.
    const double volume = cells.volume() / 8;
    return {.volume = whole_ + 0.5 * volume * static_cast<double>(hits),
            .error = 0.5 * volume * std::sqrt(static_cast<double>(deviants))};
  }

 private:
  struct Counts {
    std::size_t hits = 0;      ///< points inside
    std::size_t deviants = 0;  ///< octants with one of their two points inside
  };

  /// Keeps the cells whose middle is so near to the surface that it may pass through them. Counts the others.
  void drop_decided(OctreeLevel& cells) {
    std::vector<double> values(cells.centres.size());
    for_each_chunk(values.size(), [&](std::size_t first, std::size_t count) {
      std::ranges::copy(values_at(cells.centres.view().subview(first, count)),
                        values.begin() + static_cast<std::ptrdiff_t>(first));
    });
    const double reach = steepness_ * cells.radius();
    Points left;
    std::size_t inside = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::abs(values[i]) <= reach) {
        left.push_back(cells.centres[i]);
      } else if (values[i] < 0) {
        ++inside;
      }
    }
    whole_ += cells.volume() * static_cast<double>(inside);
    cells.centres = std::move(left);
  }

  /// Makes the last and largest level chunk by chunk.
  [[nodiscard]] Counts judge_octants(const OctreeLevel& cells) const {
    std::vector<Counts> counts(cells.centres.size() / k_chunk + 1);
    for_each_chunk(cells.centres.size(), [&](std::size_t first, std::size_t count) {
      OctreeLevel parts{.centres = {}, .half_size = cells.half_size};
      for (std::size_t i = first; i < first + count; ++i) parts.centres.push_back(cells.centres[i]);
      parts = octants(parts);
      RandomStream random(k_seed, 0, first);
      Points points;
      for (std::size_t i = 0; i < parts.centres.size(); ++i) {
        const Eigen::Vector3d low = parts.centres[i] - parts.half_size;
        const Eigen::Vector3d high = parts.centres[i] + parts.half_size;
        for (int repeat = 0; repeat < 2; ++repeat) points.push_back(random_between(low, high, random));
      }
      const std::vector<double> values = values_at(points);
      Counts& own = counts[first / k_chunk];
      for (std::size_t i = 0; i < values.size(); i += 2) {
        const int inside = (values[i] < 0 ? 1 : 0) + (values[i + 1] < 0 ? 1 : 0);
        own.hits += static_cast<std::size_t>(inside);
        own.deviants += inside == 1 ? 1U : 0U;
      }
    });
    Counts all;
    for (const Counts& one : counts) {
      all.hits += one.hits;
      all.deviants += one.deviants;
    }
    return all;
  }

  [[nodiscard]] std::vector<double> values_at(PointsView points) const {
    return implicit_value(*field_.tree, field_.primitives, points);
  }

  template <typename Work>
  void for_each_chunk(std::size_t count, const Work& work) const {
    for_each_index((count + k_chunk - 1) / k_chunk, run_,
                   [&](std::size_t chunk) { work(chunk * k_chunk, std::min(k_chunk, count - chunk * k_chunk)); });
  }

  Model field_;
  double steepness_;
  const RunContext& run_;
  double whole_ = 0;  ///< volume of the cells that are wholly inside
};

}  // namespace

VolumeEstimate tree_volume(const Model& model, const AlignedBox& box, int levels, const RunContext& run) {
  if (box.isEmpty() || box.sizes().minCoeff() <= 0) return {};
  return Sampler(model, run).estimate(box, levels);
}

}  // namespace cloud2csg
