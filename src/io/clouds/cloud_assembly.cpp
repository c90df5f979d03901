#include "io/clouds/cloud_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace cloud2csg {
namespace {

constexpr std::array<std::string_view, 3> k_axes{"x", "y", "z"};
constexpr std::size_t k_points_per_report = std::size_t{1} << 18;

void report_point(const RunContext& run, std::size_t done, std::size_t total) {
  if (done % k_points_per_report != 0) return;
  run.throw_if_stopped();
  run.report("read", done, total, "points");
}

void check_position(const FileContent& content, FilePosition where, InvalidPoints invalid,
                    const Eigen::Vector3d& position) {
  if (invalid == InvalidPoints::keep || position.allFinite()) return;
  content.fail(where,
               fmt::format("expected finite coordinates, found ({}, {}, {})", position.x(), position.y(), position.z()),
               "remove invalid points before reading");
}

void check_sensor(const FileContent& content, FilePosition where, const Eigen::Vector3d& sensor) {
  if (sensor.allFinite()) return;
  content.fail(
      where,
      fmt::format("expected a finite position of the sensor, found ({}, {}, {})", sensor.x(), sensor.y(), sensor.z()),
      "give the position of the sensor for every point, or leave these columns out");
}

/// Scales a normal to unit length. A normal of unit length keeps its bits, so writing and reading change nothing.
Eigen::Vector3d unit_normal(const FileContent& content, FilePosition where, InvalidPoints invalid,
                            const Eigen::Vector3d& normal) {
  constexpr double k_unit_tolerance = 8 * std::numeric_limits<double>::epsilon();
  if (std::abs(normal.squaredNorm() - 1.0) <= k_unit_tolerance) return normal;
  Eigen::Vector3d unit = normal.stableNormalized();
  if (normal.allFinite() && unit.allFinite() && unit.squaredNorm() > 0.5) return unit;
  if (invalid == InvalidPoints::keep) return Eigen::Vector3d::Zero();
  content.fail(where,
               fmt::format("expected a normal that is finite and not of length zero, found ({}, {}, {})", normal.x(),
                           normal.y(), normal.z()),
               "give every point a normal, or remove the points without one");
}

[[noreturn]] void fail_empty(const FileContent& content) {
  content.fail("holds no points");
}

std::optional<std::size_t> index_of(std::span<const std::string> names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// The columns of x, y, z after one of the prefixes; absent if none exist. @throws Error at `where` for only some.
std::optional<std::array<std::size_t, 3>> find_vector(const FileContent& content, FilePosition where,
                                                      std::span<const std::string> names,
                                                      const std::array<std::string_view, 2>& prefixes,
                                                      std::string_view what) {
  std::array<std::size_t, 3> columns{};
  std::size_t found = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::optional<std::size_t> column = index_of(names, fmt::format("{}{}", prefixes[0], k_axes[axis]));
    if (!column) column = index_of(names, fmt::format("{}{}", prefixes[1], k_axes[axis]));
    if (!column) continue;
    columns[axis] = *column;
    ++found;
  }
  if (found == 0) return std::nullopt;
  if (found < 3) content.fail(where, fmt::format("expected all three coordinates of the {}, or none", what));
  return columns;
}

}  // namespace

PointLayout find_layout(const FileContent& content, FilePosition where, std::span<const std::string> names) {
  PointLayout layout{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::size_t> position = index_of(names, k_axes[axis]);
    if (!position) content.fail(where, fmt::format("expected coordinates x, y, z; there is no {}", k_axes[axis]));
    layout.position[axis] = *position;
  }
  layout.normal = find_vector(content, where, names, {"n", "normal_"}, "normal");
  layout.sensor = find_vector(content, where, names, {"sensor_", "vp_"}, "sensor's position");
  return layout;
}

CloudAssembly::CloudAssembly(const FileContent& content, std::size_t announced, std::size_t reserve,
                             InvalidPoints invalid, const RunContext& run)
    : content_(content), invalid_(invalid), run_(run), announced_(announced), reserve_(reserve) {}

void CloudAssembly::add(const CloudPoint& point, FilePosition where) {
  report_point(run_, cloud_.size(), announced_);
  if (cloud_.size() == 0) {
    cloud_.positions.reserve(reserve_);
    if (point.normal) cloud_.normals.reserve(reserve_);
    if (point.sensor) cloud_.sensor_positions.reserve(reserve_);
  }
  check_position(content_, where, invalid_, point.position);
  cloud_.positions.push_back(point.position);
  if (point.normal) cloud_.normals.push_back(unit_normal(content_, where, invalid_, *point.normal));
  if (!point.sensor) return;
  check_sensor(content_, where, *point.sensor);
  cloud_.sensor_positions.push_back(*point.sensor);
}

PointCloud CloudAssembly::finish() && {
  if (cloud_.size() == 0) fail_empty(content_);
  run_.report("read", cloud_.size(), cloud_.size(), "points");
  return std::move(cloud_);
}

PointCloud cloud_of_columns(const FileContent& content, const CloudColumns& columns, std::size_t count,
                            const std::function<std::size_t(std::size_t)>& byte_of, InvalidPoints invalid,
                            const RunContext& run) {
  if (count == 0) fail_empty(content);
  const auto decode_points = [&](const std::array<BinaryColumn, 3>& axes) {
    Points points(count);
    decode_column(axes[0], points.x);
    decode_column(axes[1], points.y);
    decode_column(axes[2], points.z);
    return points;
  };
  PointCloud cloud{.positions = decode_points(columns.position)};
  run.throw_if_stopped();
  if (columns.normal) cloud.normals = decode_points(*columns.normal);
  if (columns.sensor) cloud.sensor_positions = decode_points(*columns.sensor);
  for (std::size_t i = 0; i < count; ++i) {
    report_point(run, i, count);
    const FilePosition where{FilePosition::Unit::byte, byte_of(i)};
    check_position(content, where, invalid, cloud.positions[i]);
    if (columns.normal) cloud.normals.set(i, unit_normal(content, where, invalid, cloud.normals[i]));
    if (columns.sensor) check_sensor(content, where, cloud.sensor_positions[i]);
  }
  run.report("read", count, count, "points");
  return cloud;
}

}  // namespace cloud2csg
