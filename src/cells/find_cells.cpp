#include <algorithm>
#include <map>

#include "cells/crossings.hpp"
#include "cells/infinity.hpp"
#include "cells/surface_samples.hpp"
#include "fitness/spatial_order.hpp"

namespace cloud2csg {
namespace {

/// Puts together what points and samples say.
class ComplexBuilder {
 public:
  /// All cells of the crossings, in lexicographic order.
  void add_cells(const Crossings& crossings) {
    for (CellIndex c = 0; c < crossings.cells.size(); ++c) cells_.push_back(crossings.cells[c]);
  }

  void add_cells(const std::vector<Cell>& cells) { cells_.insert(cells_.end(), cells.begin(), cells.end()); }

  void index_cells() {
    cells_.emplace_back();
    std::ranges::sort(cells_);
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  }

  template <class Add>
  void add_patches(const Crossings& crossings, const Add& add) {
    std::vector<CellIndex> place(crossings.cells.size());
    for (CellIndex c = 0; c < place.size(); ++c) {
      place[c] = place_of(crossings.cells[c]);
    }
    for (const auto& [pair, units] : crossings.units) {
      const CellIndex inner = place[Crossings::inner(pair)];
      const CellIndex outer = place[Crossings::outer(pair)];
      const auto [first, second] = std::minmax(inner, outer);
      Patch& patch = patches_.try_emplace({first, second}, Patch{.first = first, .second = second}).first->second;
      add(patch, inner == first, static_cast<double>(units) / k_sure_units);
    }
  }

  [[nodiscard]] CellIndex place_of(const Cell& cell) const {
    return static_cast<CellIndex>(std::ranges::lower_bound(cells_, cell) - cells_.begin());
  }

  /// Turns counts of samples into areas.
  void measure_areas(std::span<const double> areas) {
    for (auto& [pair, patch] : patches_) {
      if (patch.area > 0) patch.area *= area_of_sample(patch, areas);
    }
  }

  [[nodiscard]] CellComplex take() && {
    CellComplex result;
    result.patches.reserve(patches_.size());
    for (const auto& [pair, patch] : patches_) result.patches.push_back(patch);
    result.cells = std::move(cells_);
    return result;
  }

 private:
  /// What a sample stands for at a patch: where several surfaces coincide, each of them is sampled, and their densities
  /// add up.
  [[nodiscard]] double area_of_sample(const Patch& patch, std::span<const double> areas) const {
    Cell between;
    std::ranges::set_symmetric_difference(cells_[patch.first], cells_[patch.second], std::back_inserter(between));
    double density = 0;
    for (const PrimitiveIndex p : between) density += areas[p] > 0 ? 1 / areas[p] : 0.0;
    return density > 0 ? 1 / density : 0.0;
  }

  std::vector<Cell> cells_;
  std::map<std::pair<CellIndex, CellIndex>, Patch> patches_;
};

}  // namespace

CellComplex find_cells(const PointCloud& cloud, const PrimitiveSet& primitives, const CellOptions& options,
                       const RunContext& run) {
  const AlignedBox box = bounds_of(cloud.positions);
  std::vector<std::uint32_t> order = spatial_order(cloud.positions, box, run);
  const ReachingPrimitives reaching = reaching_primitives(primitives, box, options);
  const Crossings of_points = count_crossings(cloud, order, reaching, options.tolerances, run);
  const SurfaceSamples samples = sample_surfaces(primitives, reaching.reach, box, options.samples);
  ComplexBuilder builder;
  builder.add_cells(of_points);
  Crossings of_samples;
  if (samples.points.size() > 0) {
    const PointCloud& points = samples.points;
    of_samples = count_crossings(points, spatial_order(points.positions, bounds_of(points.positions), run), reaching,
                                 options.tolerances, run);
    builder.add_cells(of_samples);
  }
  const std::vector<Cell> far = cells_at_infinity(primitives);
  builder.add_cells(far);
  builder.index_cells();
  builder.add_patches(of_points, [](Patch& patch, bool is_first_inner, double points) {
    (is_first_inner ? patch.first_in : patch.second_in) += points;
  });
  builder.add_patches(of_samples, [](Patch& patch, bool /*is_first_inner*/, double count) { patch.area += count; });
  builder.measure_areas(samples.area_of_sample);
  std::vector<CellIndex> unbounded;
  unbounded.reserve(far.size());
  for (const Cell& cell : far) unbounded.push_back(builder.place_of(cell));
  CellComplex result = std::move(builder).take();
  result.unbounded = std::move(unbounded);
  result.points_of_primitive = of_points.points_of_primitive;
  result.unassigned = of_points.unassigned;
  result.order = std::move(order);
  return result;
}

}  // namespace cloud2csg
