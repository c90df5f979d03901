#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "cells/crossings.hpp"
#include "cells/infinity.hpp"
#include "cells/surface_samples.hpp"
#include "fitness/spatial_order.hpp"

namespace cloud2csg {
namespace {

/// Puts together what points and samples say.
class ComplexBuilder {
 public:
  enum class Source : std::uint8_t { points, samples };

  CellIndex add_cell(const Cell& cell) { return cells_.find_or_insert(cell); }

  void add(const Crossings& crossings, Source source) {
    std::vector<CellIndex> number(crossings.cells.size());
    for (CellIndex c = 0; c < number.size(); ++c) number[c] = add_cell(crossings.cells[c]);
    patches_.reserve(patches_.size() + crossings.units.size());
    for (const auto& [pair, units] : crossings.units) {
      const CellIndex inner = number[Crossings::inner(pair)];
      const CellIndex outer = number[Crossings::outer(pair)];
      const double points = static_cast<double>(units) / k_sure_units;
      Patch patch{.first = inner, .second = outer};
      (source == Source::points ? patch.first_in : patch.area) = points;
      patches_.push_back(patch);
    }
  }

  /// `areas`: what a sample of each primitive stands for.
  [[nodiscard]] CellComplex build(std::span<const double> areas, std::span<const CellIndex> unbounded) && {
    CellComplex result;
    const std::vector<CellIndex> place = sort_cells(result.cells);
    for (Patch& patch : patches_) {
      patch.first = place[patch.first];
      patch.second = place[patch.second];
      if (patch.first < patch.second) continue;
      std::swap(patch.first, patch.second);
      std::swap(patch.first_in, patch.second_in);
    }
    std::ranges::sort(patches_, {}, [](const Patch& patch) { return std::pair(patch.first, patch.second); });
    for (const Patch& patch : patches_) add_to(result.patches, patch);
    for (Patch& patch : result.patches) {
      if (patch.area > 0) patch.area *= area_of_sample(result.cells[patch.first], result.cells[patch.second], areas);
    }
    result.unbounded.clear();
    for (const CellIndex cell : unbounded) result.unbounded.push_back(place[cell]);
    std::ranges::sort(result.unbounded);
    return result;
  }

 private:
  /// In lexicographic order; returns the place of each number.
  std::vector<CellIndex> sort_cells(std::vector<Cell>& sorted) const {
    std::vector<CellIndex> order(cells_.size());
    std::iota(order.begin(), order.end(), CellIndex{0});
    std::ranges::sort(order, [this](CellIndex a, CellIndex b) { return cells_[a] < cells_[b]; });
    std::vector<CellIndex> place(order.size());
    sorted.reserve(order.size());
    for (CellIndex k = 0; k < order.size(); ++k) {
      place[order[k]] = k;
      sorted.push_back(cells_[order[k]]);
    }
    return place;
  }

  /// Patches come in order. Counts are multiples of a quarter, whose sums are exact in any order.
  static void add_to(std::vector<Patch>& patches, const Patch& patch) {
    if (patches.empty() || patches.back().first != patch.first || patches.back().second != patch.second) {
      patches.push_back(patch);
      return;
    }
    patches.back().first_in += patch.first_in;
    patches.back().second_in += patch.second_in;
    patches.back().area += patch.area;
  }

  /// What a sample stands for at a patch: where several surfaces coincide, each of them is sampled, and their densities
  /// add up.
  static double area_of_sample(const Cell& first, const Cell& second, std::span<const double> areas) {
    Cell between;
    std::ranges::set_symmetric_difference(first, second, std::back_inserter(between));
    double density = 0;
    for (const PrimitiveIndex p : between) density += areas[p] > 0 ? 1 / areas[p] : 0.0;
    return density > 0 ? 1 / density : 0.0;
  }

  CellSet cells_;
  std::vector<Patch> patches_;  // by the numbers of cells, the inner one first; area: samples
};

}  // namespace

CellComplex find_cells(const PointCloud& cloud, const PrimitiveSet& primitives, const CellOptions& options,
                       const RunContext& run) {
  using Source = ComplexBuilder::Source;
  const AlignedBox box = bounds_of(cloud.positions);
  std::vector<std::uint32_t> order = spatial_order(cloud.positions, box, run);
  const ReachingPrimitives reaching = reaching_primitives(primitives, box, options);
  const Crossings of_points = count_crossings(cloud, order, reaching, options.tolerances, run);
  ComplexBuilder builder;
  builder.add_cell({});
  builder.add(of_points, Source::points);
  const SurfaceSamples samples = sample_surfaces(primitives, reaching.reach, box, options.samples, run);
  if (const PointCloud& points = samples.points; points.size() > 0) {
    const auto order_of_samples = spatial_order(points.positions, bounds_of(points.positions), run);
    builder.add(count_crossings(points, order_of_samples, reaching, options.tolerances, run), Source::samples);
  }
  std::vector<CellIndex> unbounded;
  for (const Cell& cell : cells_at_infinity(primitives)) unbounded.push_back(builder.add_cell(cell));
  CellComplex result = std::move(builder).build(samples.area_of_sample, unbounded);
  result.points_of_primitive = of_points.points_of_primitive;
  result.unassigned = of_points.unassigned;
  result.order = std::move(order);
  return result;
}

}  // namespace cloud2csg
