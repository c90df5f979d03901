#include "paper/partition/regions.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace cloud2csg {
namespace {

AlignedBox all_of_space() {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  return {Eigen::Vector3d::Constant(-k_infinity), Eigen::Vector3d::Constant(k_infinity)};
}

class Cutter {
 public:
  Cutter(std::span<const AlignedBox> reach, std::size_t limit) : reach_(reach), limit_(limit) {}

  void cut(const Region& region) {
    std::optional<Halves> best;
    for (int axis = 0; axis < 3 && region.near.size() > limit_; ++axis) {
      std::optional<Halves> halves = cut_across(region, axis);
      if (halves && (!best || halves->larger() < best->larger())) best = std::move(halves);
    }
    // Cuts that part off little would be many.
    if (!best || 8 * best->larger() > 7 * region.near.size()) {
      regions_.push_back(region);
      return;
    }
    cut(best->below);
    cut(best->above);
  }

  [[nodiscard]] std::vector<Region>& regions() { return regions_; }

 private:
  struct Halves {
    Region below, above;
    [[nodiscard]] std::size_t larger() const { return std::max(below.near.size(), above.near.size()); }
  };

  /// At the median of the middles of the boxes.
  [[nodiscard]] std::optional<Halves> cut_across(const Region& region, int axis) const {
    std::vector<double> middles;
    for (const PrimitiveIndex p : region.near) {
      const double middle = reach_[p].center()[axis];
      if (middle > region.box.min()[axis] && middle < region.box.max()[axis]) middles.push_back(middle);
    }
    if (middles.empty()) return std::nullopt;
    const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::ranges::nth_element(middles, median);
    Halves halves{.below = region, .above = region};
    halves.below.box.max()[axis] = *median;
    halves.above.box.min()[axis] = *median;
    keep_near(halves.below);
    keep_near(halves.above);
    return halves;
  }

  void keep_near(Region& region) const {
    std::erase_if(region.near, [&](PrimitiveIndex p) { return !reach_[p].intersects(region.box); });
  }

  std::span<const AlignedBox> reach_;
  std::size_t limit_;
  std::vector<Region> regions_;
};

}  // namespace

std::vector<Region> cut_into_regions(std::span<const PrimitiveIndex> primitives, std::span<const AlignedBox> reach,
                                     std::size_t limit) {
  Cutter cutter(reach, limit);
  cutter.cut({.box = all_of_space(), .near = {primitives.begin(), primitives.end()}});
  return std::move(cutter.regions());
}

}  // namespace cloud2csg
