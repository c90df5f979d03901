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
#include "raw/solids/edges.hpp"
#include "raw/solids/hidden_bends.hpp"
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

/// Places of a wall without points.
struct BarePlaces {
  Points places;
  std::vector<bool> is_crossed;  ///< by lines of sight
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
      for (const DetectedSurface& other : surfaces) {
        extend_to(other);
        const std::optional<Vector3d> bend = bend_ahead(other, surfaces, cell);
        if (bend) reach_.add(pose_.to_local(*bend).z());
      }
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
  [[nodiscard]] BarePlaces bare_places() const {
    BarePlaces bare;
    for (std::size_t row = 0; row < rows_ && !is_line_seen_.empty(); ++row) {
      for (std::size_t column = 0; column < columns_; ++column) {
        if (is_line_seen_[column] == 0 || seen_.is_any_around(row, column)) continue;
        bare.places.push_back(place_at(static_cast<double>(row) + 0.5, static_cast<double>(column) + 0.5));
        bare.is_crossed.push_back(crossed_.is_any_around(row, column));
      }
    }
    return bare;
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
        points.sensor_positions.push_back(place + std::min(cell_height(), depth_at(place)) * inward);
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
    if (static_cast<std::size_t>(within) >= k_least_floor_points) reach_.add(height);
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

/// The bare places that no sensor could see; none if many were visible.
Points hidden_places(const RolledWall& wall, const SensorViews& views, double usual, const RunContext& run) {
  const BarePlaces bare = wall.bare_places();
  const Points& places = bare.places;
  std::vector<double> densities(places.size());
  for_each_index_by_chunks(places.size(), 256, run, [&](std::size_t i) {
    densities[i] = views.density_at_bare(places[i], wall.normal_at(places[i]));
  });
  Points hidden;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!bare.is_crossed[i] && densities[i] < k_hidden_density * usual) hidden.push_back(places[i]);
  }
  const auto gaps = static_cast<double>(places.size() - hidden.size());
  const bool is_wall =
      static_cast<double>(hidden.size()) >= k_least_hidden && gaps <= k_most_gaps * static_cast<double>(places.size());
  return is_wall ? hidden : Points{};
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
    RolledWall rolled(cloud, surfaces, s, k_cell_spacings * scale.spacing);
    if (hidden_places(rolled, *views, usual, run).empty()) continue;
    for (const std::uint32_t i : lines) {
      rolled.cross(cloud.sensor_positions[i], cloud.positions[i], 3 * scale.noise + scale.spacing);
    }
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
