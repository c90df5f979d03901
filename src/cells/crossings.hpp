#pragma once

#include <span>
#include <unordered_map>

#include "cells/cell_hash.hpp"
#include "cloud2csg/advanced/cells.hpp"

/// Counts of points by the two cells at their surface, and of lines of sight by the cells that they pass through.
namespace cloud2csg {

/// Cells, numbered in the order of arrival.
class CellSet {
 public:
  CellIndex find_or_insert(const Cell& cell);
  [[nodiscard]] const Cell& operator[](CellIndex i) const { return *cells_[i]; }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }

 private:
  std::unordered_map<Cell, CellIndex, CellHash> index_;
  std::vector<const Cell*> cells_;  // keys of index_, whose addresses are stable
};

/// Units of a point that is sure of its side of every primitive. Other points count one unit.
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

/// Primitives, with data that several sets of points share.
struct ReachingPrimitives {
  const PrimitiveSet& primitives;  ///< must outlive this
  std::vector<AlignedBox> reach;   ///< by primitive: where points may be on it
  bool is_single;                  ///< distances are computed in single precision
};
[[nodiscard]] ReachingPrimitives reaching_primitives(const PrimitiveSet& primitives, const AlignedBox& points,
                                                     const CellOptions& options);

/// Counts points in shares, each with its own numbers of cells, to be summed. The number of shares depends on the
/// threads, the sums do not. There is at least one share. `order`: see spatial_order(). @throws Cancelled
[[nodiscard]] std::vector<Crossings> count_crossings(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                                     const ReachingPrimitives& reaching,
                                                     const SegmentationTolerances& tolerances, const RunContext& run);

struct SightLines;
/// As above, but `units` has lines by (cell, cell). Places near a surface, where the cell is not clear, do not count.
[[nodiscard]] std::vector<Crossings> count_lines(const SightLines& lines, const ReachingPrimitives& reaching,
                                                 const SegmentationTolerances& tolerances, const RunContext& run);

/// Places on a line of sight, which fill a byte of a BlockMask.
inline constexpr std::size_t k_places_a_line = 8;

/// Lines from sensors to points on a primitive.
struct SightLines {
  PointCloud places = {};  ///< k_places_a_line of each line, evenly within the bounds of the cloud; near lines together
  std::size_t count = 0;   ///< number of lines
  double points_each = 0;  ///< points of the cloud for each line
};

/// At most CellOptions::sight_lines lines, to points all over the cloud; none without sensor positions. Leaves out
/// points on no primitive, outliers among them. `order`: see spatial_order(). O(lines x primitives)
[[nodiscard]] SightLines find_sight_lines(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                          const ReachingPrimitives& reaching, const CellOptions& options,
                                          const RunContext& run);

}  // namespace cloud2csg
