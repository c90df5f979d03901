#include "cloud/cloud_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace cloud2csg {
namespace {

constexpr std::size_t k_points_per_report = std::size_t{1} << 18;

void report_point(const RunContext& run, std::size_t done, std::size_t total) {
  if (done % k_points_per_report != 0) return;
  run.throw_if_stopped();
  run.report("read", done, total);
}

void check_position(const FileContent& content, FilePosition where, const Eigen::Vector3d& position) {
  if (position.allFinite()) return;
  content.fail(where,
               fmt::format("expected finite coordinates, found ({}, {}, {})", position.x(), position.y(), position.z()),
               "remove invalid points before reading");
}

/// The normal at unit length. One that has it already keeps its bits, so that writing and reading changes nothing.
Eigen::Vector3d unit_normal(const FileContent& content, FilePosition where, const Eigen::Vector3d& normal) {
  constexpr double k_unit_tolerance = 8 * std::numeric_limits<double>::epsilon();
  if (std::abs(normal.squaredNorm() - 1.0) <= k_unit_tolerance) return normal;
  Eigen::Vector3d unit = normal.stableNormalized();
  if (normal.allFinite() && unit.allFinite() && unit.squaredNorm() > 0.5) return unit;
  content.fail(where,
               fmt::format("expected a normal that is finite and not of length zero, found ({}, {}, {})", normal.x(),
                           normal.y(), normal.z()),
               "give every point a normal, or leave the points without one out");
}

[[noreturn]] void fail_empty(const FileContent& content) {
  content.fail("holds no points");
}

std::optional<std::size_t> index_of(std::span<const std::string> names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

PointLayout find_layout(const FileContent& content, FilePosition where, std::span<const std::string> names) {
  constexpr std::array<std::string_view, 3> k_axes{"x", "y", "z"};
  PointLayout layout{};
  std::array<std::size_t, 3> normal{};
  std::size_t normals_found = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::size_t> position = index_of(names, k_axes[axis]);
    if (!position) content.fail(where, fmt::format("expected coordinates x, y, z; there is no {}", k_axes[axis]));
    layout.position[axis] = *position;
    std::optional<std::size_t> part = index_of(names, fmt::format("n{}", k_axes[axis]));
    if (!part) part = index_of(names, fmt::format("normal_{}", k_axes[axis]));
    if (!part) continue;
    normal[axis] = *part;
    ++normals_found;
  }
  if (normals_found == 3) {
    layout.normal = normal;
  } else if (normals_found > 0) {
    content.fail(where, "expected all three coordinates of the normal, or none");
  }
  return layout;
}

CloudAssembly::CloudAssembly(const FileContent& content, bool with_normals, std::size_t announced, std::size_t reserve,
                             const RunContext& run)
    : content_(content), run_(run), announced_(announced) {
  cloud_.positions.reserve(reserve);
  if (with_normals) cloud_.normals.reserve(reserve);
}

void CloudAssembly::add(const Eigen::Vector3d& position, FilePosition where) {
  report_point(run_, cloud_.size(), announced_);
  check_position(content_, where, position);
  cloud_.positions.push_back(position);
}

void CloudAssembly::add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, FilePosition where) {
  add(position, where);
  cloud_.normals.push_back(unit_normal(content_, where, normal));
}

PointCloud CloudAssembly::finish() && {
  if (cloud_.size() == 0) fail_empty(content_);
  run_.report("read", cloud_.size(), cloud_.size());
  return std::move(cloud_);
}

PointCloud cloud_of_columns(const FileContent& content, const CloudColumns& columns, std::size_t count,
                            const std::function<std::size_t(std::size_t)>& byte_of, const RunContext& run) {
  if (count == 0) fail_empty(content);
  const auto decode_points = [&](const std::array<BinaryColumn, 3>& axes) {
    Points points(count);
    decode_column(axes[0], points.x);
    decode_column(axes[1], points.y);
    decode_column(axes[2], points.z);
    return points;
  };
  PointCloud cloud{.positions = decode_points(columns.position), .normals = {}};
  run.throw_if_stopped();
  if (columns.normal) cloud.normals = decode_points(*columns.normal);
  for (std::size_t i = 0; i < count; ++i) {
    report_point(run, i, count);
    const FilePosition where{FilePosition::Unit::byte, byte_of(i)};
    check_position(content, where, cloud.positions[i]);
    if (columns.normal) cloud.normals.set(i, unit_normal(content, where, cloud.normals[i]));
  }
  run.report("read", count, count);
  return cloud;
}

void fail_truncated(const FileContent& content, FilePosition where, std::size_t announced, std::size_t found) {
  content.fail(where, fmt::format("the file announces {} points but ends after {}", announced, found),
               "the file is cut off or damaged: copy or export it again");
}

}  // namespace cloud2csg
