#include "primitive/displaced_bounds.hpp"

#include <algorithm>
#include <cassert>
#include <variant>
#include <vector>

namespace cloud2csg {
namespace {

/// Levels of halving, and the number of cells at which the subdivision ends earlier.
constexpr int k_levels = 7;
constexpr std::size_t k_cell_budget = 8192;

/// The cells of one level, which all have the same size.
struct Cells {
  Points centres;
  Eigen::Vector3d half_size;

  [[nodiscard]] AlignedBox box(std::size_t i) const { return {centres[i] - half_size, centres[i] + half_size}; }
};

Cells subdivided(const Cells& cells) {
  Cells children{.centres = {}, .half_size = 0.5 * cells.half_size};
  children.centres.reserve(8 * cells.centres.size());
  for (std::size_t i = 0; i < cells.centres.size(); ++i) {
    for (unsigned octant = 0; octant < 8; ++octant) {
      const Eigen::Vector3d sign((octant & 1U) != 0 ? 1 : -1, (octant & 2U) != 0 ? 1 : -1, (octant & 4U) != 0 ? 1 : -1);
      children.centres.push_back(cells.centres[i] + sign.cwiseProduct(children.half_size));
    }
  }
  return children;
}

/// Subdivides with what is known to be in the bounds in hand: cells within it need no further look.
class BoundsSearch {
 public:
  explicit BoundsSearch(const Primitive& primitive) : displaced_(primitive), undisplaced_(primitive) {
    undisplaced_.displacement.reset();
  }

  AlignedBox run(const AlignedBox& start) {
    Cells cells{.centres = {}, .half_size = 0.5 * start.sizes()};
    cells.centres.push_back(start.center());
    for (int level = 0; level < k_levels && 8 * cells.centres.size() <= k_cell_budget; ++level) {
      cells = undecided(subdivided(cells));
    }
    AlignedBox result = known_;
    for (std::size_t i = 0; i < cells.centres.size(); ++i) result.extend(cells.box(i));
    return result;
  }

 private:
  /// The cells that may hold points of the solid beyond those known. Both terms of the distance are Lipschitz: the
  /// shape's with 1, the product of sines with its frequency.
  Cells undecided(const Cells& cells) {
    const std::vector<double> total = signed_distance(displaced_, cells.centres);
    const std::vector<double> base = signed_distance(undisplaced_, cells.centres);
    for (std::size_t i = 0; i < total.size(); ++i) {
      if (total[i] <= 0) known_.extend(cells.centres[i]);
    }
    const double radius = cells.half_size.norm();
    const double sine_change = displaced_.displacement->frequency * radius;
    Cells rest{.centres = {}, .half_size = cells.half_size};
    for (std::size_t i = 0; i < total.size(); ++i) {
      const double least_sine = std::max(total[i] - base[i] - sine_change, -1.0);
      if (base[i] - radius + least_sine <= 0 && !known_.contains(cells.box(i)))
        rest.centres.push_back(cells.centres[i]);
    }
    return rest;
  }

  Primitive displaced_, undisplaced_;
  AlignedBox known_;
};

}  // namespace

AlignedBox displaced_bounds(const Primitive& primitive, const AlignedBox& start) {
  assert(primitive.displacement);
  // A formula that is only known as text may change arbitrarily fast.
  if (std::holds_alternative<Expression>(primitive.shape)) return start;
  return BoundsSearch(primitive).run(start);
}

}  // namespace cloud2csg
