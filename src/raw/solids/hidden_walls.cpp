#include "raw/solids/hidden_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/geometry/sensor_views.hpp"
#include "core/geometry/subset.hpp"
#include "raw/solids/bores.hpp"
#include "raw/solids/edges.hpp"
#include "raw/solids/wall_cells.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_wall_stage = 0x7761'6c6c;
constexpr double k_cell_spacings = 2;       // edge of a cell of a wall
constexpr std::size_t k_least_columns = 8;  // around the axis
constexpr std::size_t k_most_cells = 1'000'000;
constexpr double k_hidden_density = 0.3;  // relative to the cloud's density; a lower expected density counts as hidden
constexpr double k_most_gaps = 0.2;       // share of visible cells among those without points
constexpr double k_least_hidden = 8;      // fewer cells are no wall
constexpr std::size_t k_stray = 1000;     // one point in so many may be beyond the end of the material
constexpr std::size_t k_sectors = 16;     // around a bore

/// The range of heights where a wall is seen, or to where faces across its axis or the end of the material end it.
struct Reach {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double height) {
    low = std::min(low, height);
    high = std::max(high, height);
  }
};

/// What the sensors could see.
struct Visibility {
  const SensorViews& views;
  double usual;  ///< points per area

  /// Whether missing points at a place with this normal say nothing.
  [[nodiscard]] bool is_hidden(const Vector3d& place, const Vector3d& normal) const {
    return views.density_at_bare(place, normal) < k_hidden_density * usual;
  }
};

/// An unrolled wall, in cells along and around its axis.
class RolledWall {
 public:
  RolledWall(const PointCloud& cloud, std::span<const DetectedSurface> surfaces, std::size_t index, double cell,
             const Visibility& visibility)
      : cloud_(cloud), surface_(surfaces[index].surface), pose_(pose_from_axis(surface_.position, surface_.axis)) {
    const std::vector<std::uint32_t>& own = surfaces[index].points;
    if (is_sphere()) {
      reach_ = {.low = -surface_.radius, .high = surface_.radius};
    } else {
      for (const std::uint32_t i : own) reach_.add(pose_.to_local(cloud.positions[i]).z());
      for (const DetectedSurface& other : surfaces) {
        extend_to(other);
        const std::optional<Vector3d> bend = bend_ahead(other, surfaces, cell);
        if (bend) reach_.add(pose_.to_local(*bend).z());
      }
      if (is_whole_bore(own)) go_through(surfaces, visibility, cell);
    }
    const double radius = is_sphere() ? surface_.radius : std::max(radius_at(reach_.low), radius_at(reach_.high));
    columns_ = std::max(k_least_columns, static_cast<std::size_t>(2 * std::numbers::pi * radius / cell));
    rows_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((reach_.high - reach_.low) / cell)));
    if (rows_ > k_most_cells / columns_) return;
    seen_ = WallCells(rows_, columns_);
    crossed_ = WallCells(rows_, columns_);
    is_line_seen_.assign(columns_, is_sphere() ? 1 : 0);
    for (const std::uint32_t i : own) mark(pose_.to_local(cloud.positions[i]));
  }

  /// Marks where a line of sight from `sensor` to `point` crosses the wall: there is no wall. Nearer to the point than
  /// `clear`, it does not count: the point may be on the wall.
  void cross(const Vector3d& sensor, const Vector3d& point, double clear) {
    const Vector3d start = pose_.to_local(point);
    const Vector3d line = pose_.to_local(sensor) - start;
    const double length = line.norm();
    if (!(length > clear)) return;
    const double tangent = std::tan(surface_.half_angle);
    // The wall is where scaled(p).p = radius^2.
    const double along = is_sphere() ? 1 : surface_.type == SurfaceType::cone ? -tangent * tangent : 0;
    const double radius = surface_.type == SurfaceType::cone ? 0 : surface_.radius;
    const auto scaled = [along](const Vector3d& p) { return Vector3d(p.x(), p.y(), along * p.z()); };
    const double square = scaled(line).dot(line);
    const double half = scaled(line).dot(start);
    const double discriminant = half * half - square * (scaled(start).dot(start) - radius * radius);
    if (square == 0 || discriminant < 0) return;
    for (const double side : {-1.0, 1.0}) {
      const double share = (side * std::sqrt(discriminant) - half) / square;
      const Vector3d place = start + share * line;
      const bool is_on_line = share * length > clear && share < 1;
      if (!is_on_line || place.z() < reach_.low || place.z() > reach_.high) continue;
      crossed_.mark(row_of(place), column_of(place));
    }
  }

  /// Middles of cells that, with their surroundings, have no points, on lines along the axis that have some.
  [[nodiscard]] Points bare_places() const {
    Points bare;
    for (std::size_t row = 0; row < rows_ && !is_line_seen_.empty(); ++row) {
      for (std::size_t column = 0; column < columns_; ++column) {
        if (is_line_seen_[column] == 0 || seen_.is_any_around(row, column)) continue;
        bare.push_back(place_at(static_cast<double>(row) + 0.5, static_cast<double>(column) + 0.5));
      }
    }
    return bare;
  }

  /// Whether lines of sight cross the cell around a place or a cell beside it.
  [[nodiscard]] bool is_crossed(const Vector3d& place) const {
    const Vector3d local = pose_.to_local(place);
    return crossed_.is_any_near(row_of(local), column_of(local));
  }

  void add_points(const Vector3d& middle, PointCloud& points) const {
    const Vector3d local = pose_.to_local(middle);
    add_cell_points(
        points, surface_, row_of(local), column_of(local),
        [this](double row, double column) { return place_at(row, column); },
        [this](const Vector3d& place) { return std::min(cell_height(), depth_at(place)); });
  }

  [[nodiscard]] double length() const { return reach_.high - reach_.low; }
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
  [[nodiscard]] double cell_height() const { return length() / static_cast<double>(rows_); }
  [[nodiscard]] double row_of(const Vector3d& local) const { return (local.z() - reach_.low) / cell_height(); }
  /// Around the axis, from 0 to 1.
  static double turn_of(const Vector3d& local) {
    const double turn = std::atan2(local.y(), local.x()) / (2 * std::numbers::pi);
    return turn < 0 ? turn + 1 : turn;
  }
  [[nodiscard]] double column_of(const Vector3d& local) const { return turn_of(local) * static_cast<double>(columns_); }

  /// The place at a height and a share of the turn around the axis.
  [[nodiscard]] Vector3d on_wall(double height, double turn) const {
    const double angle = 2 * std::numbers::pi * turn;
    const double radius = radius_at(height);
    return pose_.to_world({radius * std::cos(angle), radius * std::sin(angle), height});
  }
  [[nodiscard]] Vector3d place_at(double row, double column) const {
    return on_wall(reach_.low + row * cell_height(), column / static_cast<double>(columns_));
  }

  /// Where the wall goes over into the inside of a bend, if it does.
  [[nodiscard]] std::optional<Vector3d> bend_ahead(const DetectedSurface& torus,
                                                   std::span<const DetectedSurface> surfaces, double cell) const {
    if (!torus.surface.concave || std::abs(torus.surface.minor_radius - surface_.radius) > cell) return std::nullopt;
    const std::optional<Vector3d> place = tangent_place(surface_, torus.surface, cell);
    if (!place || is_blind(surface_, *place, cloud_, surfaces)) return std::nullopt;
    const bool begins_there = std::ranges::any_of(torus.points, [&](std::uint32_t i) {
      return (cloud_.positions[i] - *place).norm() < surface_.radius + 2 * cell;
    });
    return begins_there ? place : std::nullopt;
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
    if (within >= k_least_floor_points) reach_.add(height);
  }

  /// Whether the wall is a bore, and was seen all around.
  [[nodiscard]] bool is_whole_bore(const std::vector<std::uint32_t>& own) const {
    if (surface_.type != SurfaceType::cylinder) return false;
    WallCells sectors(1, k_sectors);
    for (const std::uint32_t i : own) sectors.mark(0, k_sectors * turn_of(pose_.to_local(cloud_.positions[i])));
    return sectors.count() == k_sectors;
  }

  /// Extends the reach of a bore to where the material around it ends, unless other surfaces are in its way there or a
  /// sensor could see that there is no wall. Points on no surface may be outliers.
  void go_through(std::span<const DetectedSurface> surfaces, const Visibility& visibility, double cell) {
    constexpr double k_around = 2;  // radii; material farther off may end elsewhere
    const Reach seen = reach_;
    std::vector<double> around, within;  // heights
    for (const DetectedSurface& other : surfaces) {
      for (const std::uint32_t i : other.points) {
        const Vector3d local = pose_.to_local(cloud_.positions[i]);
        const double off = local.head<2>().norm() - surface_.radius;
        if (off > cell && off < (k_around - 1) * surface_.radius) around.push_back(local.z());
        if (off < -cell) within.push_back(local.z());
      }
    }
    if (around.empty()) return;
    std::ranges::sort(around);
    const std::size_t stray = around.size() / k_stray;
    const double low = around[stray];
    const double high = around[around.size() - 1 - stray];
    // A floor may be just where the seen part ends, and a face at the end of the material may reach into the bore.
    const auto is_free = [&](double from, double to) {
      const auto in_the_way = std::ranges::count_if(within, [&](double z) { return z > from && z < to; });
      return in_the_way < k_least_floor_points;
    };
    if (low < seen.low && is_free(low + cell, seen.low + cell) && is_hidden_between(low, seen.low, visibility)) {
      reach_.add(low);
    }
    if (high > seen.high && is_free(seen.high - cell, high - cell) && is_hidden_between(seen.high, high, visibility)) {
      reach_.add(high);
    }
  }

  [[nodiscard]] bool is_hidden_between(double low, double high, const Visibility& visibility) const {
    constexpr int k_heights = 8;
    int hidden = 0;
    for (int h = 0; h < k_heights; ++h) {
      for (std::size_t sector = 0; sector < k_sectors; ++sector) {
        const double height = low + (h + 0.5) / k_heights * (high - low);
        const Vector3d place = on_wall(height, static_cast<double>(sector) / k_sectors);
        hidden += visibility.is_hidden(place, normal_at(place)) ? 1 : 0;
      }
    }
    return hidden >= (1 - k_most_gaps) * k_heights * k_sectors;
  }

  void mark(const Vector3d& local) {
    const double column = column_of(local);
    seen_.mark(row_of(local), column);
    is_line_seen_[std::min(static_cast<std::size_t>(column), columns_ - 1)] = 1;
  }

  const PointCloud& cloud_;
  Surface surface_;
  Pose pose_;  ///< z along the axis
  Reach reach_;
  std::size_t rows_ = 1, columns_ = 1;
  WallCells seen_, crossed_;
  std::vector<char> is_line_seen_;
};

/// Whether the points that were seen determine the wall all along its length.
bool is_determined(const DetectedSurface& wall, double length, const PointCloud& cloud, const Scale& scale) {
  std::vector<Vector3d> points;
  points.reserve(wall.points.size());
  for (const std::uint32_t i : wall.points) points.push_back(cloud.positions[i]);
  const std::optional<SurfaceFit> fit = fit_surface(wall.surface, points);
  if (!fit) return false;
  const SurfaceUncertainty& off = fit->uncertainty;
  return off.position + off.radius + (off.axis + off.half_angle) * length < 3 * scale.noise + 0.5 * scale.spacing;
}

/// The bare places that no sensor could see.
Points hidden_among(const Points& bare, const RolledWall& wall, const Visibility& visibility, const RunContext& run) {
  std::vector<char> is_hidden(bare.size());
  for_each_index_by_chunks(bare.size(), 256, run, [&](std::size_t i) {
    is_hidden[i] = visibility.is_hidden(bare[i], wall.normal_at(bare[i])) ? 1 : 0;
  });
  Points hidden;
  for (std::size_t i = 0; i < bare.size(); ++i) {
    if (is_hidden[i] != 0) hidden.push_back(bare[i]);
  }
  return hidden;
}

/// Whether so many of the bare places are hidden that there is a wall.
bool is_wall(const Points& hidden, const Points& bare) {
  const auto gaps = static_cast<double>(bare.size() - hidden.size());
  return static_cast<double>(hidden.size()) >= k_least_hidden && gaps <= k_most_gaps * static_cast<double>(bare.size());
}

/// The places that no line of sight crosses.
Points uncrossed(const Points& places, const RolledWall& wall) {
  Points rest;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!wall.is_crossed(places[i])) rest.push_back(places[i]);
  }
  return rest;
}

}  // namespace

std::vector<HiddenWall> find_hidden_walls(const PointCloud& cloud, std::span<const DetectedSurface> surfaces,
                                          const Scale& scale, std::size_t seen_points, const RunContext& run) {
  std::vector<HiddenWall> walls;
  if (!cloud.has_sensor_positions()) return walls;
  std::vector<std::uint32_t> seen(seen_points);
  std::iota(seen.begin(), seen.end(), 0U);
  // Of more lines, some suffice: a gap is crossed by many.
  constexpr std::size_t k_most_lines = 200'000;
  const std::vector<std::uint32_t> lines =
      one_of_every_few(seen_points, k_most_lines, RandomStream(0, k_wall_stage, 0));
  std::optional<SensorViews> views;
  double usual = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = surfaces[s].surface;
    const bool is_rolled = surface.type != SurfaceType::plane && surface.type != SurfaceType::torus;
    if (!is_rolled || !surface.concave || surfaces[s].points.empty()) continue;
    run.throw_if_stopped();
    if (!views) {
      views.emplace(seen_points < cloud.size() ? select_points(cloud, seen) : cloud);
      usual = views->usual_density(cloud, seen, run);
    }
    const Visibility visibility{.views = *views, .usual = usual};
    RolledWall rolled(cloud, surfaces, s, k_cell_spacings * scale.spacing, visibility);
    if (!is_determined(surfaces[s], rolled.length(), cloud, scale)) continue;
    const Points bare = rolled.bare_places();
    Points hidden = hidden_among(bare, rolled, visibility, run);
    if (!is_wall(hidden, bare)) continue;
    for (const std::uint32_t i : lines) {
      rolled.cross(cloud.sensor_positions[i], cloud.positions[i], 3 * scale.noise + scale.spacing);
    }
    hidden = uncrossed(hidden, rolled);
    if (!is_wall(hidden, bare)) continue;
    HiddenWall& wall = walls.emplace_back(HiddenWall{.surface = s});
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      rolled.add_points(hidden[i], wall.points);
      wall.area += rolled.cell_area(hidden[i]);
    }
  }
  return walls;
}

}  // namespace cloud2csg
