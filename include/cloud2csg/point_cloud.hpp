#pragma once

#include <cstddef>
#include <filesystem>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Points with outward unit normals, as structure of arrays.
/// Invariant: `normals` is empty or has as many entries as `positions`.
struct PointCloud {
  Points positions;
  Points normals;

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool has_normals() const { return !normals.empty(); }
};

/// Reads .ply (ascii, binary little and big endian), .pcd (ascii, binary, binary_compressed), .xyz .xyzn .txt .pts (text); the format
/// follows the file's ending. Coordinates may be float or double; extra properties are skipped. Normals are brought to unit length.
/// O(n); 10 million points take seconds.
/// @throws Error naming the file and line or byte: missing or unreadable file, unknown ending, wrong or truncated
/// header or data, no points, a coordinate that is not finite, a normal of length zero.
[[nodiscard]] PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run = {});

struct CloudWriteOptions {
  bool binary = true;            ///< .ply and .pcd; the others are text always
  bool double_precision = true;  ///< keeps the coordinates to the last bit in binary files
};

/// Writes by the file's ending, as read_point_cloud reads. Nothing half-written: a temporary file, then a rename.
/// @throws Error when the file cannot be written, the disk is full, or the ending is unknown.
void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud, const CloudWriteOptions& options = {});

}  // namespace cloud2csg
