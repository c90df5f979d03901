#pragma once

#include "cloud2csg/point_cloud.hpp"
#include "core/base/files.hpp"
#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/file_content.hpp"

/// One reader and one writer a format; read_point_cloud() and write_point_cloud() choose by the file's ending. Readers
/// throw Error with the line or byte, or Cancelled. Writers write the whole file but do not commit it.
namespace cloud2csg {

[[nodiscard]] PointCloud read_ply(const FileContent& content, InvalidPoints invalid, const RunContext& run);
[[nodiscard]] PointCloud read_pcd(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// Rows `x y z` or `x y z nx ny nz`, the same form in the whole file.
[[nodiscard]] PointCloud read_xyz(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// Rows `x y z nx ny nz`.
[[nodiscard]] PointCloud read_xyzn(const FileContent& content, InvalidPoints invalid, const RunContext& run);
/// First the number of points, then rows `x y z`, `x y z intensity` or `x y z intensity red green blue`.
[[nodiscard]] PointCloud read_pts(const FileContent& content, InvalidPoints invalid, const RunContext& run);

void write_ply(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
void write_pcd(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
/// With normals if the cloud has them. The text format has no sensor positions.
void write_xyz(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);
/// The format has neither normals nor sensor positions.
void write_pts(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options);

}  // namespace cloud2csg
