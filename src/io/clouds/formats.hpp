#pragma once

#include "cloud2csg/point_cloud.hpp"
#include "core/base/files.hpp"
#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/file_content.hpp"

/// One reader and one writer a format; read_point_cloud() and write_point_cloud() choose by the file's ending.
/// Readers throw Error naming line or byte, or Cancelled; writers write the whole file but do not commit it.
namespace cloud2csg {

[[nodiscard]] PointCloud read_ply(const FileContent& content, InvalidPoints invalid, const RunContext& run);
[[nodiscard]] PointCloud read_pcd(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// Rows `x y z` or `x y z nx ny nz`, alike to the end.
[[nodiscard]] PointCloud read_xyz(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// Rows `x y z nx ny nz`.
[[nodiscard]] PointCloud read_xyzn(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// The number of points, then rows `x y z`, `x y z intensity` or `x y z intensity red green blue`.
[[nodiscard]] PointCloud read_pts(const FileContent& content, InvalidPoints invalid, const RunContext& run);

void write_ply(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
void write_pcd(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
/// With normals when the cloud has them; text has no place for sensor positions.
void write_xyz(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
/// Without normals and sensor positions: the format has no place for them.
void write_pts(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);

}  // namespace cloud2csg
