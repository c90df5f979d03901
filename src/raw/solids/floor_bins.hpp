#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud2csg/point_cloud.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/cubes.hpp"

namespace cloud2csg {

/// A cloud seen from above: its points in a frame with z up, and square bins over the xy plane. Bins have numbers, row
/// by row.
class FloorBins {
 public:
  /// Bins on each side of one that belong to its window.
  static constexpr std::size_t k_window = 2;

  /// The frame's origin is in the middle. `step`: edge of a bin. O(n)
  FloorBins(const PointCloud& cloud, const Eigen::Vector3d& middle, const Eigen::Vector3d& up, double step)
      : pose_(pose_from_axis(middle, up)), step_(step), points_(cloud.size()) {
    for (std::size_t i = 0; i < points_.size(); ++i) points_.set(i, pose_.to_local(cloud.positions[i]));
    const AlignedBox box = bounds_of(points_);
    top_ = box.max().z();
    origin_ = box.min().head<2>() - Eigen::Vector2d::Constant(static_cast<double>(k_window) * step);
    width_ = bins_along(box.sizes().x());
    height_ = bins_along(box.sizes().y());
  }

  struct Bin {
    std::size_t x, y;
  };
  /// Bins from the first to before the last.
  struct Window {
    std::size_t left, right, low, high;

    [[nodiscard]] std::size_t size() const { return (right - left) * (high - low); }
  };

  [[nodiscard]] const Pose& pose() const { return pose_; }
  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] const Points& points() const { return points_; }  ///< of the cloud, in the frame
  [[nodiscard]] double top() const { return top_; }               ///< of the points
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t count() const { return width_ * height_; }

  [[nodiscard]] Bin bin_at(std::size_t number) const { return {.x = number % width_, .y = number / width_}; }
  /// Precondition: the place is over the bins. Its height does not matter.
  [[nodiscard]] std::size_t number_of(const Eigen::Vector3d& place) const {
    const Eigen::Vector2d at = (place.head<2>() - origin_) / step_;
    return static_cast<std::size_t>(at.y()) * width_ + static_cast<std::size_t>(at.x());
  }
  [[nodiscard]] bool is_over(const Eigen::Vector3d& place) const {
    const Eigen::Vector2d at = (place.head<2>() - origin_) / step_;
    return (at.array() >= 0).all() && at.x() < static_cast<double>(width_) && at.y() < static_cast<double>(height_);
  }
  /// A place in a bin; shares in [0, 1).
  [[nodiscard]] Eigen::Vector2d place_in(std::size_t number, double x_share, double y_share) const {
    const auto [x, y] = bin_at(number);
    return origin_ + step_ * Eigen::Vector2d(static_cast<double>(x) + x_share, static_cast<double>(y) + y_share);
  }

  [[nodiscard]] Window window_around(std::size_t number) const {
    const auto [x, y] = bin_at(number);
    return {.left = x - std::min(x, k_window),
            .right = std::min(x + k_window + 1, width_),
            .low = y - std::min(y, k_window),
            .high = std::min(y + k_window + 1, height_)};
  }
  /// Calls work(number) for each bin of the window.
  template <class Work>
  void for_each_around(std::size_t number, Work work) const {
    const Window window = window_around(number);
    for (std::size_t y = window.low; y < window.high; ++y) {
      for (std::size_t x = window.left; x < window.right; ++x) work(y * width_ + x);
    }
  }

  /// Connected groups of bins.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> groups_of(const std::vector<std::uint32_t>& bins) const {
    std::vector<std::uint64_t> squares;
    squares.reserve(bins.size());
    for (const std::uint32_t bin : bins) {
      const auto [x, y] = bin_at(bin);
      squares.push_back(cube_of({static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, 0.5}, 1));
    }
    std::vector<std::vector<std::uint32_t>> groups = connected_groups(squares);
    for (std::vector<std::uint32_t>& group : groups) {
      for (std::uint32_t& bin : group) bin = bins[bin];
    }
    return groups;
  }

 private:
  [[nodiscard]] std::size_t bins_along(double extent) const {
    return static_cast<std::size_t>(extent / step_) + 2 * k_window + 1;
  }

  Pose pose_;
  double step_;
  Points points_;
  Eigen::Vector2d origin_;
  std::size_t width_ = 0, height_ = 0;
  double top_ = 0;
};

}  // namespace cloud2csg
