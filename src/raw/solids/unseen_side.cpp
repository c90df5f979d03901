#include "raw/solids/unseen_side.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "raw/solids/edges.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint64_t k_side_stage = 0x756e'7365'656e;
constexpr double k_least_share = 0.02;   ///< share of the surface; less is a hole, not a side
constexpr double k_least_cosine = 0.5;   ///< between the side's direction and the sum of normals
constexpr double k_same_cosine = 0.999;  ///< directions closer than this are one
constexpr double k_most_doubt = 0.8;     ///< greatest ratio of doubtful to missing layers
/// Least cosine between the direction to a sensor and the side's normal for seeing the side.
constexpr double k_sensor_cosine = 0.1;
constexpr std::size_t k_window = 2;  ///< bins on each side in which a bin's layers are counted

/// Points with areas, and the area-weighted sum of their normals.
struct Surroundings {
  const PointCloud& cloud;
  std::span<const double> areas;
  double area = 0;
  Vector3d sum = Vector3d::Zero();
  Vector3d middle;
};

Surroundings survey(const PointCloud& cloud, std::span<const double> areas, const Scale& scale) {
  Surroundings all{.cloud = cloud, .areas = areas, .middle = scale.box.center()};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    all.sum += all.areas[i] * cloud.normals[i];
    all.area += all.areas[i];
  }
  return all;
}

bool is_seen(const Surroundings& all, const Vector3d& normal) {
  const Points& sensors = all.cloud.sensor_positions;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Vector3d way = sensors[i] - all.middle;
    if (normal.dot(way) > k_sensor_cosine * way.norm()) return true;
  }
  return false;
}

/// Directions from possibly missing sides into the solid.
std::vector<Vector3d> directions_up(const Surroundings& all, std::span<const DetectedSurface> surfaces) {
  std::vector<Vector3d> ups;
  const auto add = [&](const Vector3d& up) {
    if (up.dot(all.sum) < k_least_cosine * all.sum.norm()) return;
    if (std::ranges::any_of(ups, [&](const Vector3d& other) { return other.dot(up) > k_same_cosine; })) return;
    if (!is_seen(all, -up)) ups.push_back(up);
  };
  for (const DetectedSurface& found : surfaces) {
    if (found.surface.type == SurfaceType::sphere) continue;
    add(found.surface.axis);
    add(-found.surface.axis);
  }
  if (ups.empty()) add(all.sum.normalized());
  return ups;
}

/// The cloud in a frame with z up. Counts, in square bins over the xy plane, the layers of the surface above.
class LayerCount {
 public:
  LayerCount(const Surroundings& all, const Vector3d& up)
      : pose_(pose_from_axis(all.middle, up)), step_(std::sqrt(all.area / static_cast<double>(all.cloud.size()))) {
    Points local(all.cloud.size());
    for (std::size_t i = 0; i < local.size(); ++i) local.set(i, pose_.to_local(all.cloud.positions[i]));
    const AlignedBox box = bounds_of(local);
    origin_ = box.min().head<2>() - Vector2d::Constant(static_cast<double>(k_window) * step_);
    width_ = bins_along(box.sizes().x());
    height_ = bins_along(box.sizes().y());
    sums_.assign((width_ + 1) * (height_ + 1), 0.0);
    double heights = 0, layers = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto x = static_cast<std::size_t>((local.x[i] - origin_.x()) / step_);
      const auto y = static_cast<std::size_t>((local.y[i] - origin_.y()) / step_);
      const double layer = all.areas[i] * all.cloud.normals[i].dot(up);
      sum(x + 1, y + 1) += layer;
      heights += layer * local.z[i];
      layers += layer;
    }
    for (std::size_t y = 1; y <= height_; ++y) {
      for (std::size_t x = 1; x <= width_; ++x) sum(x, y) += sum(x - 1, y) + sum(x, y - 1) - sum(x - 1, y - 1);
    }
    foot_ = low_end(std::move(local.z));
    mean_height_ = heights / layers - foot_;
    judge();
  }

  [[nodiscard]] double step() const { return step_; }
  /// Above the missing side.
  [[nodiscard]] double mean_height() const { return mean_height_; }
  /// Certainty of a missing side: bins with a missing layer minus doubtful bins.
  [[nodiscard]] double score() const { return missing_ - doubt_; }
  [[nodiscard]] double doubt() const { return doubt_; }
  [[nodiscard]] double missing() const { return missing_; }

  /// A place in each bin with a missing layer, at the height of the lowest points; world coordinates.
  [[nodiscard]] Points missing_places() const {
    RandomStream random(0, k_side_stage, 0);
    Points places;
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        if (layers(x, y) <= 0.5) continue;
        const double along_x = static_cast<double>(x) + random.uniform();
        const double along_y = static_cast<double>(y) + random.uniform();
        places.push_back(pose_.to_world({origin_.x() + step_ * along_x, origin_.y() + step_ * along_y, foot_}));
      }
    }
    return places;
  }

 private:
  void judge() {
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        const double found = layers(x, y);
        missing_ += found > 0.5 ? 1 : 0;
        doubt_ += std::abs(found - (found > 0.5 ? 1 : 0));
      }
    }
  }
  [[nodiscard]] std::size_t bins_along(double extent) const {
    return static_cast<std::size_t>(extent / step_) + 2 * k_window + 1;
  }
  /// The lowest height, except for a few stray points.
  static double low_end(std::vector<double> heights) {
    const std::size_t few = std::min(heights.size() / 2000, heights.size() - 1);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(few), heights.end());
    return heights[few];
  }
  [[nodiscard]] double& sum(std::size_t x, std::size_t y) { return sums_[y * (width_ + 1) + x]; }
  [[nodiscard]] double sum(std::size_t x, std::size_t y) const { return sums_[y * (width_ + 1) + x]; }
  /// Number of layers around a bin that face up minus those that face down.
  [[nodiscard]] double layers(std::size_t x, std::size_t y) const {
    const std::size_t left = x - std::min(x, k_window), right = std::min(x + k_window + 1, width_);
    const std::size_t low = y - std::min(y, k_window), high = std::min(y + k_window + 1, height_);
    const double area = step_ * step_ * static_cast<double>((right - left) * (high - low));
    return (sum(right, high) - sum(left, high) - sum(right, low) + sum(left, low)) / area;
  }

  Pose pose_;
  double step_;
  Vector2d origin_;
  std::size_t width_ = 0, height_ = 0;
  std::vector<double> sums_;  ///< over all bins below and to the left of a corner
  double foot_ = 0, mean_height_ = 0;
  double missing_ = 0, doubt_ = 0;
};

}  // namespace

std::optional<UnseenSide> find_unseen_side(const PointCloud& cloud, std::span<const double> areas,
                                           std::span<const DetectedSurface> surfaces, const Scale& scale,
                                           const RunContext& run) {
  const Surroundings all = survey(cloud, areas, scale);
  if (!(all.sum.norm() > k_least_share * all.area)) return std::nullopt;
  std::optional<LayerCount> best;
  Vector3d best_up = Vector3d::Zero();
  for (const Vector3d& up : directions_up(all, surfaces)) {
    run.throw_if_stopped();
    LayerCount count(all, up);
    if (count.mean_height() < 3 * scale.spacing + 6 * scale.noise) continue;  // a sheet
    if (!best || count.score() > best->score()) {
      best = std::move(count);
      best_up = up;
    }
  }
  if (!best || best->doubt() > k_most_doubt * best->missing()) return std::nullopt;
  const double found = best->missing() * best->step() * best->step();
  if (found < k_least_share * all.area) return std::nullopt;

  UnseenSide side{.normal = -best_up, .share = found / (all.area + found), .points = {}};
  side.points.positions = best->missing_places();
  for (std::size_t i = 0; i < side.points.size(); ++i) {
    side.points.normals.push_back(side.normal);
    if (!cloud.has_sensor_positions()) continue;
    side.points.sensor_positions.push_back(side.points.positions[i] + scale.diagonal * side.normal);
  }
  return side;
}

}  // namespace cloud2csg
