#pragma once

#include <span>
#include <unordered_map>

#include "cells/cell_hash.hpp"
#include "cloud2csg/advanced/cells.hpp"

/// What points say of the cells on either side of the surface that they are on, and lines of sight of those that they
/// pass through.
namespace cloud2csg {

/// Cells by number, in the order in which they were met.
class CellSet {
 public:
  CellIndex find_or_insert(const Cell& cell);
  [[nodiscard]] const Cell& operator[](CellIndex i) const { return *cells_[i]; }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }

 private:
  std::unordered_map<Cell, CellIndex, CellHash> index_;
  std::vector<const Cell*> cells_;  // keys of index_, which stay where they are
};

/// A point counts so many units; one where it is not sure on which side of some primitive it is.
inline constexpr std::uint64_t k_sure_units = 4;

struct Crossings {
  CellSet cells;
  std::unordered_map<std::uint64_t, std::uint64_t> units;  ///< by (inner cell, outer cell), packed
  std::vector<std::size_t> points_of_primitive;
  std::size_t unassigned = 0;

  [[nodiscard]] static std::uint64_t pair(CellIndex inner, CellIndex outer) {
    return std::uint64_t{inner} << 32U | outer;
  }
  [[nodiscard]] static CellIndex inner(std::uint64_t pair) { return static_cast<CellIndex>(pair >> 32U); }
  [[nodiscard]] static CellIndex outer(std::uint64_t pair) { return static_cast<CellIndex>(pair); }
};

/// Primitives and what is worked out of them once for several sets of points.
struct ReachingPrimitives {
  const PrimitiveSet& primitives;  ///< must outlive this
  std::vector<AlignedBox> reach;   ///< by primitive: where points may be on it
  bool is_single;                  ///< distances are computed in single precision
};
[[nodiscard]] ReachingPrimitives reaching_primitives(const PrimitiveSet& primitives, const AlignedBox& points,
                                                     const CellOptions& options);

/// Shares of the points, each with numbers of cells of its own, to be summed: how many there are depends on the
/// threads, the sums do not. There is at least one. `order`: see spatial_order(). @throws Cancelled
[[nodiscard]] std::vector<Crossings> count_crossings(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                                     const ReachingPrimitives& reaching,
                                                     const SegmentationTolerances& tolerances, const RunContext& run);

struct SightLines;
/// The same of lines of sight: `units` has lines, by the cell that they pass through, twice. Places near a surface,
/// where it is not clear which cell they are in, say nothing.
[[nodiscard]] std::vector<Crossings> count_lines(const SightLines& lines, const ReachingPrimitives& reaching,
                                                 const SegmentationTolerances& tolerances, const RunContext& run);

/// Places on a line of sight; they fill a byte of a BlockMask.
inline constexpr std::size_t k_places_a_line = 8;

/// Lines from sensors to points on a primitive.
struct SightLines {
  PointCloud places =
      {};  ///< k_places_a_line of a line, evenly along it within the bounds of the cloud; neighbours first
  std::size_t count = 0;   ///< lines
  double points_each = 0;  ///< for how many points of the cloud a line stands
};

/// At most CellOptions::sight_lines of them, to points all over the cloud; none where it has no sensor positions.
/// Points on no primitive, outliers among them, are left out. `order`: see spatial_order(). O(lines x primitives)
[[nodiscard]] SightLines find_sight_lines(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                          const ReachingPrimitives& reaching, const CellOptions& options,
                                          const RunContext& run);

}  // namespace cloud2csg
