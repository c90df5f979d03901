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
#include "core/geometry/subset.hpp"
#include "raw/solids/floor_bins.hpp"
#include "raw/solids/wall_ends.hpp"

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

/// Counts the layers of the surface above each bin of the cloud, seen from above.
class LayerCount {
 public:
  LayerCount(const Surroundings& all, const Vector3d& up)
      : cloud_(all.cloud),
        up_(up),
        bins_(all.cloud, all.middle, up, std::sqrt(all.area / static_cast<double>(all.cloud.size()))),
        sums_((bins_.width() + 1) * (bins_.height() + 1), 0.0),
        face_above_(bins_.count(), 0.0),
        wall_end_(bins_.count(), std::numeric_limits<double>::infinity()),
        is_open_(bins_.count(), false) {
    double heights = 0, layers = 0;
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const auto [x, y] = bins_.bin_at(bins_.number_of(bins_.points()[i]));
      const double layer = all.areas[i] * cloud_.normals[i].dot(up);
      sum(x + 1, y + 1) += layer;
      heights += layer * bins_.points().z[i];
      layers += layer;
    }
    for (std::size_t y = 1; y <= bins_.height(); ++y) {
      for (std::size_t x = 1; x <= bins_.width(); ++x) sum(x, y) += sum(x - 1, y) + sum(x, y - 1) - sum(x - 1, y - 1);
    }
    const std::vector<double>& z = bins_.points().z;
    foot_ = low_end(z);
    standing_ = std::ranges::count_if(z, [&](double height) { return height < foot_ + k_standing * step(); });
    mean_height_ = heights / layers - foot_;
    judge();
  }

  [[nodiscard]] double step() const { return bins_.step(); }
  /// Above the missing side.
  [[nodiscard]] double mean_height() const { return mean_height_; }
  /// Certainty of a missing side: bins with a missing layer minus doubtful bins.
  [[nodiscard]] double score() const { return missing_ - doubt_; }
  [[nodiscard]] double doubt() const { return doubt_; }
  [[nodiscard]] double missing() const { return missing_; }
  /// Number of points just above the missing side. Walls that end on it have many.
  [[nodiscard]] std::ptrdiff_t standing() const { return standing_; }

  /// Leaves out the bins in which a layer is missing higher than the side: where lines of sight pass below all that
  /// faces up, such as under an overhang, and behind walls, if these end at one height above the side. Nearer to their
  /// points than `clear`, lines do not count.
  void leave_open(std::span<const DetectedSurface> surfaces, double clear) {
    if (!cloud_.has_sensor_positions()) return;
    leave_open_below_lines(clear);
    const std::vector<WallEnd> ends = wall_ends(cloud_, surfaces, bins_, above_foot());
    for (const WallEnd& end : ends) wall_end_[bins_.number_of(end.place)] = end.place.z();
    const std::vector<std::uint32_t> behind = bins_behind(ends, bins_, above_foot(), bins_with_missing_layer(false));
    for (const std::uint32_t bin : behind) is_open_[bin] = true;
    undersides_ = find_undersides();
    for (const std::uint32_t bin : behind) is_open_[bin] = false;
    for (const Underside& underside : undersides_) {
      for (const std::uint32_t bin : underside.bins) is_open_[bin] = true;
    }
    judge();
  }

  /// A place in each bin with a missing layer, at the height of the lowest points; world coordinates.
  [[nodiscard]] Points missing_places(const Outline& outline) const {
    return places_at(foot_, bins_with_missing_layer(false), outline);
  }

  /// The same for each underside: groups of bins that are left open below walls that end at one height.
  [[nodiscard]] std::vector<Points> underside_places(const Outline& outline) const {
    std::vector<Points> places;
    for (const auto& [height, bins] : undersides_) places.push_back(places_at(height, bins, outline));
    return places;
  }

  /// The convex hull of the cloud.
  [[nodiscard]] Outline outline_from_above() const {
    boost::geometry::model::multi_point<PlanePoint> shadow;
    for (std::size_t i = 0; i < cloud_.size(); ++i) shadow.emplace_back(bins_.points().x[i], bins_.points().y[i]);
    Outline outline;
    boost::geometry::convex_hull(shadow, outline);
    return outline;
  }

 private:
  struct Underside {
    double height;
    std::vector<std::uint32_t> bins;
  };
  void judge() {
    missing_ = doubt_ = 0;
    for (std::size_t bin = 0; bin < bins_.count(); ++bin) {
      if (is_open_[bin]) continue;
      const double found = layers(bin);
      missing_ += found > 0.5 ? 1 : 0;
      doubt_ += std::abs(found - (found > 0.5 ? 1 : 0));
    }
  }
  /// Clearly higher than the side: lowest points of walls that stand on it scatter over less.
  [[nodiscard]] double above_foot() const {
    constexpr double k_clear = 5;  // steps; with 2, walls that few sensors see down to the foot make undersides
    return foot_ + k_clear * step();
  }
  void leave_open_below_lines(double clear) {
    constexpr double k_most_bins = 0.8;  // of the bins in a window; beside a wall, lines to it cross half of them
    const std::vector<double> lines = lowest_lines(clear);
    const std::vector<double> faces = lowest_faces();
    for (std::size_t bin = 0; bin < bins_.count(); ++bin) {
      double face = std::numeric_limits<double>::infinity();
      bins_.for_each_around(bin, [&](std::size_t other) { face = std::min(face, faces[other]); });
      std::size_t crossed = 0;
      bins_.for_each_around(bin, [&](std::size_t other) { crossed += lines[other] < face - clear ? 1 : 0; });
      face_above_[bin] = face;
      const auto all = static_cast<double>(bins_.window_around(bin).size());
      is_open_[bin] = std::isfinite(face) && static_cast<double>(crossed) > k_most_bins * all;
    }
  }
  /// Groups of open bins with a missing layer, if the walls around end at one height, which is below nearly all that
  /// faces up above them.
  [[nodiscard]] std::vector<Underside> find_undersides() const {
    constexpr double k_least_below = 0.75;  // of the bins; fewer are a wrong guess, such as across a conical recess
    std::vector<Underside> undersides;
    for (std::vector<std::uint32_t>& group : bins_.groups_of(bins_with_missing_layer(true))) {
      std::vector<double> ends;
      for (const std::uint32_t bin : group) {
        const double end = wall_end_[bin];
        if (end > above_foot() && end < face_above_[bin] - k_standing * step()) ends.push_back(end);
      }
      const std::optional<double> height = common_end(std::move(ends), step());
      if (!height) continue;
      const auto all = static_cast<double>(group.size());
      std::erase_if(group,
                    [&](std::uint32_t bin) { return !std::isfinite(face_above_[bin]) || face_above_[bin] <= *height; });
      if (static_cast<double>(group.size()) < k_least_below * all) continue;
      undersides.push_back({.height = *height, .bins = std::move(group)});
    }
    return undersides;
  }
  /// By bin: the least height of the points that face up.
  [[nodiscard]] std::vector<double> lowest_faces() const {
    std::vector<double> lowest(bins_.count(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      if (!(cloud_.normals[i].dot(up_) > k_faces_up)) continue;
      double& own = lowest[bins_.number_of(bins_.points()[i])];
      own = std::min(own, bins_.points().z[i]);
    }
    return lowest;
  }
  /// By bin: the least height of the lines of sight over it.
  [[nodiscard]] std::vector<double> lowest_lines(double clear) const {
    constexpr std::size_t k_most_lines = 200'000;  // they cross nearly each bin under an overhang
    std::vector<double> lowest(bins_.count(), std::numeric_limits<double>::infinity());
    for (const std::uint32_t i : one_of_every_few(cloud_.size(), k_most_lines, RandomStream(0, k_side_stage, 1))) {
      const Vector3d start = bins_.points()[i];
      const Vector3d line = bins_.pose().to_local(cloud_.sensor_positions[i]) - start;
      // Above the part there is nothing to cross.
      const double length = line.norm() * std::min(1.0, line.z() > 0 ? (bins_.top() - start.z()) / line.z() : 1.0);
      if (!std::isfinite(length)) continue;
      const Vector3d way = line.normalized();
      for (double along = clear; along < length; along += step()) {
        const Vector3d place = start + along * way;
        if (!bins_.is_over(place)) break;
        double& own = lowest[bins_.number_of(place)];
        own = std::min(own, place.z());
      }
    }
    return lowest;
  }
  /// Ascending.
  [[nodiscard]] std::vector<std::uint32_t> bins_with_missing_layer(bool is_open) const {
    std::vector<std::uint32_t> bins;
    for (std::uint32_t bin = 0; bin < bins_.count(); ++bin) {
      if (is_open_[bin] == is_open && layers(bin) > 0.5) bins.push_back(bin);
    }
    return bins;
  }
  /// A place in each bin, but none beyond the outline: windows reach across the border of the part, and the last points
  /// before it stand for more area than they have. World coordinates.
  [[nodiscard]] Points places_at(double height, const std::vector<std::uint32_t>& bins, const Outline& outline) const {
    RandomStream random(0, k_side_stage, 0);
    Points places;
    for (const std::uint32_t bin : bins) {
      const double x = random.uniform();
      const double y = random.uniform();
      const Vector2d place = bins_.place_in(bin, x, y);
      if (!boost::geometry::within(PlanePoint(place.x(), place.y()), outline)) continue;
      places.push_back(bins_.pose().to_world({place.x(), place.y(), height}));
    }
    return places;
  }
  /// The lowest height, without strays.
  static double low_end(std::vector<double> heights) {
    const std::size_t few = std::min(heights.size() / k_stray, heights.size() - 1);
    std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(few), heights.end());
    return heights[few];
  }
  [[nodiscard]] double& sum(std::size_t x, std::size_t y) { return sums_[y * (bins_.width() + 1) + x]; }
  [[nodiscard]] double sum(std::size_t x, std::size_t y) const { return sums_[y * (bins_.width() + 1) + x]; }
  /// Number of layers around a bin that face up minus those that face down.
  [[nodiscard]] double layers(std::size_t bin) const {
    const FloorBins::Window window = bins_.window_around(bin);
    const auto [left, right, low, high] = window;
    const double area = step() * step() * static_cast<double>(window.size());
    return (sum(right, high) - sum(left, high) - sum(right, low) + sum(left, low)) / area;
  }

  const PointCloud& cloud_;
  Vector3d up_;
  FloorBins bins_;
  std::vector<double> sums_;        // over all bins below and to the left of a corner
  std::vector<double> face_above_;  // by bin: the lowest face around it that faces up
  std::vector<double> wall_end_;    // by bin: where a wall over it ends; infinite without one
  std::vector<bool> is_open_;       // by bin: nothing is missing at the height of the side
  std::vector<Underside> undersides_ = {};
  double foot_ = 0, mean_height_ = 0;
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
  best.leave_open(surfaces, 3 * scale.noise + scale.spacing);
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
  const Outline outline = best.outline_from_above();
  UnseenSide side{
      .normal = -best_up, .share = found / (all.area + found), .points = closing(best.missing_places(outline))};
  if (side.points.size() == 0) return std::nullopt;
  for (Points& places : best.underside_places(outline)) {
    if (places.size() > 0) side.undersides.push_back(closing(std::move(places)));
  }
  return side;
}

}  // namespace cloud2csg
