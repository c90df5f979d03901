#include "raw/solids/unseen_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/advanced/winding_number.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/geometry/sensor_views.hpp"
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

using Eigen::Vector3d;

constexpr double k_cell_spacings = 2;       // edge of a cell of a wall
constexpr std::size_t k_least_columns = 8;  // around the axis
constexpr std::size_t k_most_cells = 1'000'000;
constexpr double k_hidden_density = 0.3;  // relative to the cloud's density; a lower expected density counts as hidden
constexpr double k_most_gaps = 0.2;       // share of visible cells among those without points
constexpr double k_least_hidden = 8;      // fewer cells are no wall
constexpr std::size_t k_least_floor_points = 10;

/// The range of heights where a wall is seen, or to faces across its axis that end it.
struct Reach {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double height) {
    low = std::min(low, height);
    high = std::max(high, height);
  }
};

/// An unrolled wall, in cells along and around its axis.
class RolledWall {
 public:
  RolledWall(const PointCloud& cloud, std::span<const DetectedSurface> surfaces, std::size_t index, double cell)
      : cloud_(cloud), surface_(surfaces[index].surface), pose_(pose_from_axis(surface_.position, surface_.axis)) {
    const std::vector<std::uint32_t>& own = surfaces[index].points;
    if (is_sphere()) {
      reach_ = {.low = -surface_.radius, .high = surface_.radius};
    } else {
      for (const std::uint32_t i : own) reach_.add(pose_.to_local(cloud.positions[i]).z());
      for (const DetectedSurface& other : surfaces) extend_to(other);
    }
    const double radius = is_sphere() ? surface_.radius : std::max(radius_at(reach_.low), radius_at(reach_.high));
    columns_ = std::max(k_least_columns, static_cast<std::size_t>(2 * std::numbers::pi * radius / cell));
    rows_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((reach_.high - reach_.low) / cell)));
    if (rows_ > k_most_cells / columns_) return;
    is_seen_.assign(rows_ * columns_, 0);
    is_line_seen_.assign(columns_, is_sphere() ? 1 : 0);
    for (const std::uint32_t i : own) mark(pose_.to_local(cloud.positions[i]));
  }

  /// Middles of cells that, with their surroundings, have no points, on lines along the axis that have some.
  [[nodiscard]] Points bare_places() const {
    Points places;
    for (std::size_t row = 0; row < rows_ && !is_seen_.empty(); ++row) {
      for (std::size_t column = 0; column < columns_; ++column) {
        if (is_line_seen_[column] != 0 && is_bare(row, column))
          places.push_back(place_at(static_cast<double>(row) + 0.5, static_cast<double>(column) + 0.5));
      }
    }
    return places;
  }

  void add_points(const Vector3d& middle, PointCloud& points) const {
    const Vector3d local = pose_.to_local(middle);
    const double row = row_of(local);
    const double column = column_of(local);
    for (const double along : {-0.25, 0.25}) {
      for (const double around : {-0.25, 0.25}) {
        const Vector3d place = place_at(row + along, column + around);
        const Vector3d inward = normal(surface_, place);
        points.positions.push_back(place);
        points.normals.push_back(inward);
        points.sensor_positions.push_back(place + depth_at(place) * inward);
      }
    }
  }

  [[nodiscard]] Vector3d normal_at(const Vector3d& place) const { return normal(surface_, place); }
  [[nodiscard]] double cell_area(const Vector3d& place) const {
    // A sphere's cell has the area of its projection onto the enclosing cylinder (Archimedes).
    const double width = 2 * std::numbers::pi * depth_at(place) / static_cast<double>(columns_);
    return width * cell_height() / std::cos(surface_.half_angle);
  }

 private:
  [[nodiscard]] bool is_sphere() const { return surface_.type == SurfaceType::sphere; }
  [[nodiscard]] double radius_at(double height) const {
    if (is_sphere()) return std::sqrt(std::max(0.0, surface_.radius * surface_.radius - height * height));
    return surface_.type == SurfaceType::cone ? std::max(height, 0.0) * std::tan(surface_.half_angle) : surface_.radius;
  }
  /// Distance from a place of the wall to the middle of the space inside.
  [[nodiscard]] double depth_at(const Vector3d& place) const {
    return is_sphere() ? surface_.radius : radius_at(pose_.to_local(place).z());
  }
  [[nodiscard]] double cell_height() const { return (reach_.high - reach_.low) / static_cast<double>(rows_); }
  [[nodiscard]] double row_of(const Vector3d& local) const { return (local.z() - reach_.low) / cell_height(); }
  [[nodiscard]] double column_of(const Vector3d& local) const {
    const double turn = std::atan2(local.y(), local.x()) / (2 * std::numbers::pi);
    return (turn < 0 ? turn + 1 : turn) * static_cast<double>(columns_);
  }

  [[nodiscard]] Vector3d place_at(double row, double column) const {
    const double height = reach_.low + row * cell_height();
    const double angle = 2 * std::numbers::pi * column / static_cast<double>(columns_);
    const double radius = radius_at(height);
    return pose_.to_world({radius * std::cos(angle), radius * std::sin(angle), height});
  }

  /// Extends the reach to a face across the axis that faces the space inside the wall.
  void extend_to(const DetectedSurface& face) {
    if (face.surface.type != SurfaceType::plane || !are_parallel(face.surface.axis, surface_.axis)) return;
    const double height = pose_.to_local(face.surface.position).z();
    const bool faces_up = face.surface.axis.dot(surface_.axis) > 0;
    if (faces_up ? height >= reach_.low : height <= reach_.high) return;
    const double radius = radius_at(height);
    const auto within = std::ranges::count_if(
        face.points, [&](std::uint32_t i) { return pose_.to_local(cloud_.positions[i]).head<2>().norm() < radius; });
    if (static_cast<std::size_t>(within) >= k_least_floor_points) reach_.add(height);
  }

  void mark(const Vector3d& local) {
    const std::size_t row = std::min(static_cast<std::size_t>(std::max(row_of(local), 0.0)), rows_ - 1);
    const std::size_t column = std::min(static_cast<std::size_t>(column_of(local)), columns_ - 1);
    is_seen_[row * columns_ + column] = 1;
    is_line_seen_[column] = 1;
  }

  [[nodiscard]] bool is_bare(std::size_t row, std::size_t column) const {
    for (std::size_t r = row - std::min<std::size_t>(row, 1); r <= std::min(row + 1, rows_ - 1); ++r) {
      for (const std::size_t step : {columns_ - 1, columns_, columns_ + 1}) {
        if (is_seen_[r * columns_ + (column + step) % columns_] != 0) return false;
      }
    }
    return true;
  }

  const PointCloud& cloud_;
  Surface surface_;
  Pose pose_;  ///< z along the axis
  Reach reach_;
  std::size_t rows_ = 1, columns_ = 1;
  std::vector<char> is_seen_, is_line_seen_;
};

/// The bare places that no sensor could see; none if many were visible.
Points hidden_places(const RolledWall& wall, const SensorViews& views, double usual, const RunContext& run) {
  const Points bare = wall.bare_places();
  std::vector<char> is_hidden(bare.size());
  for_each_index_by_chunks(bare.size(), 256, run, [&](std::size_t i) {
    is_hidden[i] = views.density_at(bare[i], wall.normal_at(bare[i])) < k_hidden_density * usual ? 1 : 0;
  });
  Points hidden;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    if (is_hidden[i] != 0) hidden.push_back(bare[i]);
  }
  const auto gaps = static_cast<double>(bare.size() - hidden.size());
  const bool is_wall =
      static_cast<double>(hidden.size()) >= k_least_hidden && gaps <= k_most_gaps * static_cast<double>(bare.size());
  return is_wall ? hidden : Points{};
}

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

std::vector<HiddenWall> find_hidden_walls(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                          const Scale& scale, const RunContext& run) {
  std::vector<HiddenWall> walls;
  if (!cloud.has_sensor_positions()) return walls;
  std::optional<SensorViews> views;
  double usual = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = surfaces[s].surface;
    const bool is_rolled = surface.type != SurfaceType::plane && surface.type != SurfaceType::torus;
    if (!is_rolled || !surface.concave || surfaces[s].points.empty()) continue;
    run.throw_if_stopped();
    if (!views) {
      views.emplace(cloud);
      std::vector<std::uint32_t> order(cloud.size());
      std::iota(order.begin(), order.end(), 0U);
      usual = views->usual_density(cloud, order, run);
    }
    const RolledWall rolled(cloud, surfaces, s, k_cell_spacings * scale.spacing);
    HiddenWall wall{.surface = s};
    const Points hidden = hidden_places(rolled, *views, usual, run);
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      rolled.add_points(hidden[i], wall.points);
      wall.area += rolled.cell_area(hidden[i]);
    }
    if (wall.points.size() > 0) walls.push_back(std::move(wall));
  }
  return walls;
}

}  // namespace cloud2csg
