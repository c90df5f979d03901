#include "pipeline/regions.hpp"

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
    const std::optional<Cut> plane = region.near.size() > limit_ ? best_cut(region) : std::nullopt;
    if (!plane) {
      regions_.push_back(region);
      return;
    }
    Region below = region;
    Region above = region;
    below.box.max()[plane->axis] = plane->position;
    above.box.min()[plane->axis] = plane->position;
    keep_near(below);
    keep_near(above);
    if (std::max(below.near.size(), above.near.size()) == region.near.size()) {
      regions_.push_back(region);
      return;
    }
    cut(below);
    cut(above);
  }

  [[nodiscard]] std::vector<Region>& regions() { return regions_; }

 private:
  struct Cut {
    int axis;
    double position;
  };

  /// Across the axis along which the middles of the boxes are farthest apart, at the median.
  [[nodiscard]] std::optional<Cut> best_cut(const Region& region) const {
    AlignedBox middles;
    std::vector<Eigen::Vector3d> all;
    for (const PrimitiveIndex p : region.near) {
      if (!reach_[p].sizes().allFinite()) continue;
      all.emplace_back(reach_[p].center());
      middles.extend(all.back());
    }
    if (all.empty()) return std::nullopt;
    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const auto median = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::ranges::nth_element(all, median, {}, [axis](const Eigen::Vector3d& middle) { return middle[axis]; });
    const double position = (*median)[axis];
    if (position <= region.box.min()[axis] || position >= region.box.max()[axis]) return std::nullopt;
    return Cut{.axis = static_cast<int>(axis), .position = position};
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
