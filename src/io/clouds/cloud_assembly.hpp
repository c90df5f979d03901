#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "cloud2csg/point_cloud.hpp"
#include "io/clouds/file_content.hpp"
#include "io/clouds/scalar_type.hpp"

namespace cloud2csg {

/// What is known of a point: three coordinates each of its position and, if there are any, of normal and sensor. They
/// are numbers (CloudPoint), or which property, column or field holds them (PointLayout), or binary columns
/// (CloudColumns).
template <typename Vector>
struct PointParts {
  Vector position;
  std::optional<Vector> normal = {};
  std::optional<Vector> sensor = {};

  /// The same parts, each changed by `change`.
  [[nodiscard]] auto map(const auto& change) const -> PointParts<decltype(change(position))> {
    PointParts<decltype(change(position))> changed{.position = change(position)};
    if (normal) changed.normal = change(*normal);
    if (sensor) changed.sensor = change(*sensor);
    return changed;
  }
};
using PointLayout = PointParts<std::array<std::size_t, 3>>;
using CloudPoint = PointParts<Eigen::Vector3d>;
using CloudColumns = PointParts<std::array<BinaryColumn, 3>>;

/// Finds x, y, z, nx, ny, nz (or normal_x, normal_y, normal_z) and sensor_x, sensor_y, sensor_z (or vp_x, vp_y, vp_z,
/// as the Point Cloud Library has them) among the names of a file's columns.
/// @throws Error at `where` when a coordinate is missing or only part of a normal or sensor position is there.
[[nodiscard]] PointLayout find_layout(const FileContent& content, FilePosition where,
                                      std::span<const std::string> names);

/// What to do with a coordinate that is not finite, or a normal that is not finite or has no length: throw an Error, or
/// keep the point with positions as they are and such normals zero, for others to drop.
enum class InvalidPoints { refuse, keep };

/// Builds a cloud point by point, as text gives them; checks each and reports progress.
class CloudAssembly {
 public:
  /// `announced` is 0 when the number of points is not known; `reserve` is how many to make room for.
  CloudAssembly(const FileContent& content, std::size_t announced, std::size_t reserve, InvalidPoints invalid,
                const RunContext& run);

  /// Precondition: all points have the same parts.
  /// @throws Error at `where` for an invalid point that is to be refused; Cancelled.
  void add(const CloudPoint& point, FilePosition where);

  [[nodiscard]] std::size_t size() const { return cloud_.size(); }
  /// @throws Error when there are no points.
  [[nodiscard]] PointCloud finish() &&;

 private:
  const FileContent& content_;
  InvalidPoints invalid_;
  const RunContext& run_;
  std::size_t announced_;
  std::size_t reserve_;
  PointCloud cloud_;
};

/// The `count` points of binary columns. `byte_of` gives a point's place in the file.
/// @throws Error for an invalid point that is to be refused, or when count is 0; Cancelled.
[[nodiscard]] PointCloud cloud_of_columns(const FileContent& content, const CloudColumns& columns, std::size_t count,
                                          const std::function<std::size_t(std::size_t)>& byte_of, InvalidPoints invalid,
                                          const RunContext& run);

}  // namespace cloud2csg
