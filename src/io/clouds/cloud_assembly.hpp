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

/// Position and optional normal and sensor of a point, three coordinates each: as numbers (CloudPoint), as indices of
/// properties, columns or fields (PointLayout), or as binary columns (CloudColumns).
template <typename Vector>
struct PointParts {
  Vector position;
  std::optional<Vector> normal = {};
  std::optional<Vector> sensor = {};

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

/// Finds x, y, z, nx, ny, nz (or normal_x, normal_y, normal_z) and sensor_x, sensor_y, sensor_z (or vp_x, vp_y, vp_z as
/// in the Point Cloud Library) among the names of a file's columns.
/// @throws Error at `where` when a coordinate is missing or a normal or sensor position is incomplete.
[[nodiscard]] PointLayout find_layout(const FileContent& content, FilePosition where,
                                      std::span<const std::string> names);

/// How to treat a coordinate that is not finite, or a normal that is not finite or has no length: throw an Error, or
/// keep the point. A kept point has its position unchanged and its invalid normal set to zero, for the caller to drop.
enum class InvalidPoints { refuse, keep };

/// Builds a cloud from text point by point. It checks each point and reports progress.
class CloudAssembly {
 public:
  /// `announced` is the number of points, 0 if unknown; `reserve` is the number to allocate.
  CloudAssembly(const FileContent& content, std::size_t announced, std::size_t reserve, InvalidPoints invalid,
                const RunContext& run);

  /// Precondition: all points have the same parts. @throws Error at `where` if the point is to be refused; Cancelled.
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

/// Builds a cloud of `count` points from binary columns. `byte_of` gives a point's byte position in the file.
/// @throws Error for an invalid point under `refuse`, or when count is 0; Cancelled.
[[nodiscard]] PointCloud cloud_of_columns(const FileContent& content, const CloudColumns& columns, std::size_t count,
                                          const std::function<std::size_t(std::size_t)>& byte_of, InvalidPoints invalid,
                                          const RunContext& run);

}  // namespace cloud2csg
