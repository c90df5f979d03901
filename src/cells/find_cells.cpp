#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "cells/crossings.hpp"
#include "cells/surface_samples.hpp"
#include "cloud2csg/advanced/cells.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/sensor_views.hpp"
#include "core/geometry/spatial_order.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_directions = 1024;
constexpr std::uint64_t k_infinity_stream = 0x696e66696e697479;

Eigen::Vector3d any_direction(RandomStream& random) {
  for (;;) {
    Eigen::Vector3d direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const double square = direction.squaredNorm();
    if (square > 0 && square <= 1) return direction;
  }
}

/// The cells that reach to infinity, ascending: the half-spaces that hold far-off places in each of many directions.
/// Without half-spaces, only the outside cell.
std::vector<Cell> cells_at_infinity(const PrimitiveSet& primitives) {
  std::vector<PrimitiveIndex> half_spaces;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
    if (std::holds_alternative<HalfSpace>(primitives[p].shape)) half_spaces.push_back(p);
  }
  if (half_spaces.empty()) return {Cell()};
  std::vector<Cell> cells;
  RandomStream random(0, k_infinity_stream);
  for (std::size_t i = 0; i < k_directions; ++i) {
    const Eigen::Vector3d direction = any_direction(random);
    Cell& cell = cells.emplace_back();
    for (const PrimitiveIndex p : half_spaces) {
      const Eigen::Vector3d outward = primitives[p].pose.orientation * Eigen::Vector3d::UnitZ();
      if (direction.dot(outward) < 0) cell.push_back(p);
    }
  }
  std::ranges::sort(cells);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

class ComplexBuilder {
 public:
  /// The source of crossings. Samples that no sensor could see contribute only their cells.
  enum class Source : std::uint8_t { points, samples, hidden_samples };

  CellIndex add_cell(const Cell& cell) { return cells_.find_or_insert(cell); }

  void add(std::span<const Crossings> shares, Source source) {
    std::size_t count = patches_.size();
    for (const Crossings& share : shares) count += share.units.size();
    patches_.reserve(count);
    for (const Crossings& share : shares) add_share(share, source);
  }

  /// Adds cells known to be empty, since sensors saw through them. Each line stands for `points` points. Lines are
  /// summed as integers, so that the sums do not depend on the shares.
  void add_seen_through(std::span<const Crossings> shares, double points) {
    for (const Crossings& share : shares) {
      for (const auto& [pair, lines] : share.units) {
        const CellIndex cell = add_cell(share.cells[Crossings::inner(pair)]);
        seen_through_.resize(std::max<std::size_t>(seen_through_.size(), cell + 1));
        seen_through_[cell] += lines;
      }
    }
    points_a_line_ = points;
  }

  /// `areas`: the area that a sample of each primitive stands for.
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
    if (!seen_through_.empty()) {
      seen_through_.resize(place.size());
      result.seen_through.resize(place.size());
      for (CellIndex c = 0; c < place.size(); ++c)
        result.seen_through[place[c]] = points_a_line_ * static_cast<double>(seen_through_[c]);
    }
    result.unbounded.clear();
    for (const CellIndex cell : unbounded) result.unbounded.push_back(place[cell]);
    std::ranges::sort(result.unbounded);
    return result;
  }

 private:
  void add_share(const Crossings& crossings, Source source) {
    std::vector<CellIndex> number(crossings.cells.size());
    for (CellIndex c = 0; c < number.size(); ++c) number[c] = add_cell(crossings.cells[c]);
    for (const auto& [pair, units] : crossings.units) {
      const CellIndex inner = number[Crossings::inner(pair)];
      const CellIndex outer = number[Crossings::outer(pair)];
      const double points = static_cast<double>(units) / k_sure_units;
      Patch patch{.first = inner, .second = outer};
      if (source == Source::points) patch.first_in = points;
      if (source == Source::samples) patch.area = points;
      patches_.push_back(patch);
    }
  }

  /// Sorts lexicographically. Returns the place of each number.
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

  /// The area of a sample at a patch. Where surfaces coincide, each of them is sampled, and their densities add up.
  static double area_of_sample(const Cell& first, const Cell& second, std::span<const double> areas) {
    Cell between;
    std::ranges::set_symmetric_difference(first, second, std::back_inserter(between));
    double density = 0;
    for (const PrimitiveIndex p : between) density += areas[p] > 0 ? 1 / areas[p] : 0.0;
    return density > 0 ? 1 / density : 0.0;
  }

  CellSet cells_;
  std::vector<Patch> patches_;               // by cell numbers, the inner one first; area: samples
  std::vector<std::uint64_t> seen_through_;  // by cell number: lines
  double points_a_line_ = 0;
};

void add_counts(const Crossings& share, CellComplex& sum) {
  for (std::size_t p = 0; p < sum.points_of_primitive.size(); ++p) {
    sum.points_of_primitive[p] += share.points_of_primitive[p];
  }
  sum.unassigned += share.unassigned;
}

constexpr std::uint64_t k_volume_stream = 0x766f6c756d65'73;

Points places_in(const AlignedBox& box, std::size_t count) {
  RandomStream random(0, k_volume_stream);
  Points places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) places.push_back(random_between(box.min(), box.max(), random));
  return places;
}

}  // namespace

CellComplex find_cells(const PointCloud& cloud, const PrimitiveSet& primitives, const CellOptions& options,
                       const RunContext& run) {
  using Source = ComplexBuilder::Source;
  const AlignedBox box = bounds_of(cloud.positions);
  std::vector<std::uint32_t> order = spatial_order(cloud.positions, box, run);
  const ReachingPrimitives reaching = reaching_primitives(primitives, box, options);
  const std::vector<Crossings> of_points = count_crossings(cloud, order, reaching, options.tolerances, run);
  ComplexBuilder builder;
  builder.add_cell({});
  builder.add(of_points, Source::points);
  // The stage goes on over fewer points, which must not show as progress.
  const RunContext quiet{.stop = run.stop, .on_progress = {}, .threads = run.threads};
  const SurfaceSamples samples = sample_surfaces(primitives, reaching.reach, box, options.samples, run);
  const auto add_samples = [&](const PointCloud& points, Source source) {
    if (points.size() == 0) return;
    const auto order_of_samples = spatial_order(points.positions, bounds_of(points.positions), run);
    builder.add(count_crossings(points, order_of_samples, reaching, options.tolerances, quiet), source);
  };
  if (cloud.has_sensor_positions()) {
    const std::vector<bool> seen = are_seen(samples.points, cloud, order, run);
    add_samples(select_points(samples.points, places_where(seen)), Source::samples);
    add_samples(select_points(samples.points, places_where(seen, false)), Source::hidden_samples);
  } else {
    add_samples(samples.points, Source::samples);
  }
  if (const SightLines lines = find_sight_lines(cloud, order, reaching, options, run); lines.count > 0) {
    builder.add_seen_through(count_lines(lines, reaching, options.tolerances, quiet), lines.points_each);
  }
  std::vector<CellIndex> unbounded;
  for (const Cell& cell : cells_at_infinity(primitives)) unbounded.push_back(builder.add_cell(cell));
  CellComplex result = std::move(builder).build(samples.area_of_sample, unbounded);
  result.points_of_primitive.resize(primitives.size());
  for (const Crossings& share : of_points) add_counts(share, result);
  result.order = std::move(order);
  return result;
}

CellVolumes measure_volumes(const CellComplex& complex, const PrimitiveSet& primitives, const AlignedBox& box,
                            std::size_t places, const RunContext& run) {
  const Points points = places_in(box, places);
  std::vector<std::vector<std::uint32_t>> inside(primitives.size());  // by primitive: places
  for_each_index(primitives.size(), run, [&](std::size_t p) {
    if (!reach(primitives[p], 0).intersects(box)) return;
    const std::vector<double> distances = signed_distance(primitives[p], points);
    for (std::uint32_t i = 0; i < distances.size(); ++i) {
      if (distances[i] < 0) inside[p].push_back(i);
    }
  });
  std::vector<Cell> cell_of(places);
  for (PrimitiveIndex p = 0; p < inside.size(); ++p) {
    for (const std::uint32_t i : inside[p]) cell_of[i].push_back(p);
  }
  CellVolumes volumes{.of_cell = std::vector<double>(complex.cells.size())};
  const double of_place = box.volume() / static_cast<double>(places);
  for (const Cell& cell : cell_of) {
    const auto found = std::ranges::lower_bound(complex.cells, cell);
    const bool is_known = found != complex.cells.end() && *found == cell;
    (is_known ? volumes.of_cell[static_cast<std::size_t>(found - complex.cells.begin())] : volumes.elsewhere) +=
        of_place;
  }
  return volumes;
}

}  // namespace cloud2csg
