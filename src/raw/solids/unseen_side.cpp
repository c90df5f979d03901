#include "raw/solids/unseen_side.hpp"

#include <algorithm>
#include <boost/geometry/algorithms/convex_hull.hpp>
#include <boost/geometry/algorithms/within.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/ring.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/random.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/cubes.hpp"
#include "core/geometry/subset.hpp"
#include "raw/solids/edges.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint64_t k_side_stage = 0x756e'7365'656e;
constexpr double k_least_share = 0.005;       ///< share of the surface; less is a hole, not a side
constexpr double k_least_cosine = 0.5;        ///< between the side's direction and the sum of normals
constexpr double k_same_cosine = 0.999;       ///< directions closer than this are one
constexpr double k_alike_directions = 0.985;  ///< cosine, of 10 degrees
constexpr double k_most_doubt = 0.8;          ///< greatest ratio of doubtful to missing layers
/// Least cosine between the direction to a sensor and the side's normal for seeing the side.
constexpr double k_sensor_cosine = 0.1;
constexpr std::size_t k_stray = 2000;  ///< one point in so many may be below the side
constexpr double k_faces_up = 0.5;     ///< cosine
constexpr double k_standing = 2;       ///< steps above the missing side; the noise is much less
constexpr std::size_t k_window = 2;    ///< bins on each side in which a bin's layers are counted

using PlanePoint = boost::geometry::model::d2::point_xy<double>;
using Outline = boost::geometry::model::ring<PlanePoint>;

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
      : up_(up),
        pose_(pose_from_axis(all.middle, up)),
        step_(std::sqrt(all.area / static_cast<double>(all.cloud.size()))) {
    Points local(all.cloud.size());
    for (std::size_t i = 0; i < local.size(); ++i) local.set(i, pose_.to_local(all.cloud.positions[i]));
    const AlignedBox box = bounds_of(local);
    origin_ = box.min().head<2>() - Vector2d::Constant(static_cast<double>(k_window) * step_);
    width_ = bins_along(box.sizes().x());
    height_ = bins_along(box.sizes().y());
    sums_.assign((width_ + 1) * (height_ + 1), 0.0);
    is_open_.assign(width_ * height_, false);
    face_above_.assign(width_ * height_, foot_);
    double heights = 0, layers = 0;
    for (std::size_t i = 0; i < local.size(); ++i) {
      const auto [x, y] = bin_of({local.x[i], local.y[i]});
      const double layer = all.areas[i] * all.cloud.normals[i].dot(up);
      sum(x + 1, y + 1) += layer;
      heights += layer * local.z[i];
      layers += layer;
    }
    for (std::size_t y = 1; y <= height_; ++y) {
      for (std::size_t x = 1; x <= width_; ++x) sum(x, y) += sum(x - 1, y) + sum(x, y - 1) - sum(x - 1, y - 1);
    }
    foot_ = low_end(local.z, k_stray);
    top_ = box.max().z();
    standing_ = std::ranges::count_if(local.z, [&](double z) { return z < foot_ + k_standing * step_; });
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
  /// Number of points just above the missing side. Walls that end on it have many.
  [[nodiscard]] std::ptrdiff_t standing() const { return standing_; }

  /// Leaves out the bins where lines of sight pass below all that faces up, such as those under an overhang: what is
  /// missing there is higher than the side. Nearer to their points than `clear`, lines do not count.
  void leave_open(const PointCloud& cloud, double clear) {
    if (!cloud.has_sensor_positions()) return;
    constexpr double k_most_bins = 0.8;  // of the bins in a window; beside a wall, lines to it cross half of them
    const std::vector<double> lines = lowest_lines(cloud, clear);
    const std::vector<double> faces = lowest_points(cloud, [](double up) { return up > k_faces_up; });
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        const Window window = window_around(x, y);
        double face = std::numeric_limits<double>::infinity();
        for_each_bin(window, [&](std::size_t bin) { face = std::min(face, faces[bin]); });
        std::size_t crossed = 0;
        for_each_bin(window, [&](std::size_t bin) { crossed += lines[bin] < face - clear ? 1 : 0; });
        face_above_[y * width_ + x] = face;
        is_open_[y * width_ + x] =
            std::isfinite(face) && static_cast<double>(crossed) > k_most_bins * static_cast<double>(window.size());
      }
    }
    judge();
  }

  /// A place in each bin with a missing layer, at the height of the lowest points; world coordinates.
  [[nodiscard]] Points missing_places(const PointCloud& cloud) const {
    return places_at(foot_, bins_with_missing_layer(false), outline_of(cloud));
  }

  /// The same for each group of bins that are left open, if the walls around it end at one height: world coordinates.
  [[nodiscard]] std::vector<Points> underside_places(const PointCloud& cloud) const {
    constexpr std::ptrdiff_t k_least_walls = 12;  // bins; fewer agree by chance
    const std::vector<double> walls = lowest_points(cloud, [](double up) { return std::abs(up) < k_faces_up; });
    const Outline outline = outline_of(cloud);
    std::vector<Points> undersides;
    for (const std::vector<std::uint32_t>& group : groups_of(bins_with_missing_layer(true))) {
      std::vector<double> ends;
      for (const std::uint32_t bin : group) {
        const bool is_below =
            walls[bin] > foot_ + k_standing * step_ && walls[bin] < face_above_[bin] - k_standing * step_;
        if (is_below) ends.push_back(walls[bin]);
      }
      if (std::ssize(ends) < k_least_walls) continue;
      const double middle = median_of(ends);
      const auto off = std::erase_if(ends, [&](double end) { return std::abs(end - middle) > 2 * step_; });
      // Most lowest points are somewhat higher than the end of their wall.
      if (3 * off < ends.size()) undersides.push_back(places_at(low_end(ends, 20), group, outline));
    }
    return undersides;
  }

 private:
  struct Bin {
    std::size_t x, y;
  };
  void judge() {
    missing_ = doubt_ = 0;
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        if (is_open_[y * width_ + x]) continue;
        const double found = layers(x, y);
        missing_ += found > 0.5 ? 1 : 0;
        doubt_ += std::abs(found - (found > 0.5 ? 1 : 0));
      }
    }
  }
  /// By bin: the least height of the points whose normals have a suitable cosine with the direction up.
  template <class IsSuitable>
  [[nodiscard]] std::vector<double> lowest_points(const PointCloud& cloud, IsSuitable is_suitable) const {
    std::vector<double> lowest(is_open_.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (!is_suitable(cloud.normals[i].dot(up_))) continue;
      const Vector3d local = pose_.to_local(cloud.positions[i]);
      double& own = lowest[index_of(local.head<2>())];
      own = std::min(own, local.z());
    }
    return lowest;
  }
  /// By bin: the least height of the lines of sight over it.
  [[nodiscard]] std::vector<double> lowest_lines(const PointCloud& cloud, double clear) const {
    constexpr std::size_t k_most_lines = 200'000;  // they cross nearly each bin under an overhang
    std::vector<double> lowest(is_open_.size(), std::numeric_limits<double>::infinity());
    for (const std::uint32_t i : one_of_every_few(cloud.size(), k_most_lines, RandomStream(0, k_side_stage, 1))) {
      const Vector3d start = pose_.to_local(cloud.positions[i]);
      const Vector3d line = pose_.to_local(cloud.sensor_positions[i]) - start;
      // Above the part there is nothing to cross.
      const double length = line.norm() * std::min(1.0, line.z() > 0 ? (top_ - start.z()) / line.z() : 1.0);
      if (!std::isfinite(length)) continue;
      const Vector3d way = line.normalized();
      for (double along = clear; along < length; along += step_) {
        const Vector3d place = start + along * way;
        if (!is_over(place.head<2>())) break;
        double& own = lowest[index_of(place.head<2>())];
        own = std::min(own, place.z());
      }
    }
    return lowest;
  }
  /// Ascending.
  [[nodiscard]] std::vector<std::uint32_t> bins_with_missing_layer(bool is_open) const {
    std::vector<std::uint32_t> bins;
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        const std::size_t bin = y * width_ + x;
        if (is_open_[bin] == is_open && layers(x, y) > 0.5) bins.push_back(static_cast<std::uint32_t>(bin));
      }
    }
    return bins;
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
  /// The convex hull of the cloud, seen from above.
  [[nodiscard]] Outline outline_of(const PointCloud& cloud) const {
    boost::geometry::model::multi_point<PlanePoint> shadow;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3d local = pose_.to_local(cloud.positions[i]);
      shadow.emplace_back(local.x(), local.y());
    }
    Outline outline;
    boost::geometry::convex_hull(shadow, outline);
    return outline;
  }
  /// A place in each bin, but none beyond the outline: windows reach across the border of the part, and the last points
  /// before it stand for more area than they have. World coordinates.
  [[nodiscard]] Points places_at(double height, const std::vector<std::uint32_t>& bins, const Outline& outline) const {
    RandomStream random(0, k_side_stage, 0);
    Points places;
    for (const std::uint32_t bin : bins) {
      const auto [column, row] = bin_at(bin);
      const double x = static_cast<double>(column) + random.uniform();
      const double y = static_cast<double>(row) + random.uniform();
      const PlanePoint place(origin_.x() + step_ * x, origin_.y() + step_ * y);
      if (!boost::geometry::within(place, outline)) continue;
      places.push_back(pose_.to_world({place.x(), place.y(), height}));
    }
    return places;
  }
  [[nodiscard]] Bin bin_at(std::size_t index) const { return {.x = index % width_, .y = index / width_}; }
  /// Precondition: the place is over the bins.
  [[nodiscard]] Bin bin_of(const Vector2d& place) const {
    const Vector2d at = (place - origin_) / step_;
    return {static_cast<std::size_t>(at.x()), static_cast<std::size_t>(at.y())};
  }
  [[nodiscard]] std::size_t index_of(const Vector2d& place) const {
    const auto [x, y] = bin_of(place);
    return y * width_ + x;
  }
  [[nodiscard]] bool is_over(const Vector2d& place) const {
    const Vector2d at = (place - origin_) / step_;
    return (at.array() >= 0).all() && at.x() < static_cast<double>(width_) && at.y() < static_cast<double>(height_);
  }
  [[nodiscard]] std::size_t bins_along(double extent) const {
    return static_cast<std::size_t>(extent / step_) + 2 * k_window + 1;
  }
  /// The lowest height, except for one in so many.
  static double low_end(std::vector<double> heights, std::size_t stray) {
    const std::size_t few = std::min(heights.size() / stray, heights.size() - 1);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(few), heights.end());
    return heights[few];
  }
  /// Bins from the first to before the last.
  struct Window {
    std::size_t left, right, low, high;

    [[nodiscard]] std::size_t size() const { return (right - left) * (high - low); }
  };
  template <class Work>
  void for_each_bin(const Window& window, Work work) const {
    for (std::size_t y = window.low; y < window.high; ++y) {
      for (std::size_t x = window.left; x < window.right; ++x) work(y * width_ + x);
    }
  }
  [[nodiscard]] Window window_around(std::size_t x, std::size_t y) const {
    return {.left = x - std::min(x, k_window),
            .right = std::min(x + k_window + 1, width_),
            .low = y - std::min(y, k_window),
            .high = std::min(y + k_window + 1, height_)};
  }
  [[nodiscard]] double& sum(std::size_t x, std::size_t y) { return sums_[y * (width_ + 1) + x]; }
  [[nodiscard]] double sum(std::size_t x, std::size_t y) const { return sums_[y * (width_ + 1) + x]; }
  /// Number of layers around a bin that face up minus those that face down.
  [[nodiscard]] double layers(std::size_t x, std::size_t y) const {
    const Window window = window_around(x, y);
    const auto [left, right, low, high] = window;
    const double area = step_ * step_ * static_cast<double>(window.size());
    return (sum(right, high) - sum(left, high) - sum(right, low) + sum(left, low)) / area;
  }

  Vector3d up_;
  Pose pose_;
  double step_;
  Vector2d origin_;
  std::size_t width_ = 0, height_ = 0;
  std::vector<double> sums_;        ///< over all bins below and to the left of a corner
  std::vector<double> face_above_;  ///< by bin: the lowest face around it that faces up
  std::vector<bool> is_open_;       ///< by bin: nothing is missing at the height of the side
  double foot_ = 0, top_ = 0, mean_height_ = 0;
  double missing_ = 0, doubt_ = 0;
  std::ptrdiff_t standing_ = 0;
};

}  // namespace

std::optional<UnseenSide> find_unseen_side(const PointCloud& cloud, std::span<const double> areas,
                                           std::span<const DetectedSurface> surfaces, const Scale& scale,
                                           const RunContext& run) {
  const Surroundings all = survey(cloud, areas, scale);
  if (!(all.sum.norm() > k_least_share * all.area)) return std::nullopt;
  struct Candidate {
    Vector3d up;
    double score;
    std::ptrdiff_t standing;
  };
  std::vector<Candidate> candidates;
  for (const Vector3d& up : directions_up(all, surfaces)) {
    run.throw_if_stopped();
    const LayerCount count(all, up);
    if (count.mean_height() < 3 * scale.spacing + 6 * scale.noise) continue;  // a sheet
    candidates.push_back({.up = up, .score = count.score(), .standing = count.standing()});
  }
  if (candidates.empty()) return std::nullopt;
  // Directions nearly alike count the same layers, but walls end on the right one.
  const Vector3d nearly = std::ranges::max_element(candidates, {}, &Candidate::score)->up;
  std::erase_if(candidates, [&](const Candidate& other) { return other.up.dot(nearly) < k_alike_directions; });
  const Vector3d best_up = std::ranges::max_element(candidates, {}, &Candidate::standing)->up;
  LayerCount best(all, best_up);
  best.leave_open(cloud, 3 * scale.noise + scale.spacing);
  if (best.doubt() > k_most_doubt * best.missing()) return std::nullopt;
  const double found = best.missing() * best.step() * best.step();
  if (found < k_least_share * all.area) return std::nullopt;

  const auto closing = [&](Points places) {
    PointCloud points{.positions = std::move(places)};
    for (std::size_t i = 0; i < points.size(); ++i) {
      points.normals.push_back(-best_up);
      if (!cloud.has_sensor_positions()) continue;
      points.sensor_positions.push_back(points.positions[i] - scale.diagonal * best_up);
    }
    return points;
  };
  UnseenSide side{
      .normal = -best_up, .share = found / (all.area + found), .points = closing(best.missing_places(cloud))};
  for (Points& places : best.underside_places(cloud)) side.undersides.push_back(closing(std::move(places)));
  return side;
}

}  // namespace cloud2csg
