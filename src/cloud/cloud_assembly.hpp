#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "cloud/file_content.hpp"
#include "cloud/scalar_type.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg {

/// Which property, column or field holds x, y, z and, if there are any, the three coordinates of the normal.
struct PointLayout {
  std::array<std::size_t, 3> position;
  std::optional<std::array<std::size_t, 3>> normal = {};
};

/// Finds x, y, z and nx, ny, nz (or normal_x, normal_y, normal_z) among the names of a file's columns.
/// @throws Error at `where` when a coordinate is missing or only part of a normal is there.
[[nodiscard]] PointLayout find_layout(const FileContent& content, FilePosition where,
                                      std::span<const std::string> names);

/// Builds a cloud point by point, as text gives them; checks each and reports progress.
class CloudAssembly {
 public:
  /// `announced` is 0 when the number of points is not known; `reserve` is how many to make room for.
  CloudAssembly(const FileContent& content, bool with_normals, std::size_t announced, std::size_t reserve,
                const RunContext& run);

  /// @throws Error at `where` for a coordinate that is not finite or a normal of length zero; Cancelled.
  void add(const Eigen::Vector3d& position, FilePosition where);
  void add(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, FilePosition where);

  [[nodiscard]] std::size_t size() const { return cloud_.size(); }
  /// @throws Error when there are no points.
  [[nodiscard]] PointCloud finish() &&;

 private:
  const FileContent& content_;
  const RunContext& run_;
  std::size_t announced_;
  PointCloud cloud_;
};

/// The binary columns of x, y, z and, if there are any, of the normal.
struct CloudColumns {
  std::array<BinaryColumn, 3> position;
  std::optional<std::array<BinaryColumn, 3>> normal = {};
};

/// The `count` points of binary columns. `byte_of` gives a point's place in the file.
/// @throws Error for a point that is no good or when count is 0; Cancelled.
[[nodiscard]] PointCloud cloud_of_columns(const FileContent& content, const CloudColumns& columns, std::size_t count,
                                          const std::function<std::size_t(std::size_t)>& byte_of,
                                          const RunContext& run);

/// @throws Error: `announced` points were announced, only `found` are there.
[[noreturn]] void fail_truncated(const FileContent& content, FilePosition where, std::size_t announced,
                                 std::size_t found);

}  // namespace cloud2csg
