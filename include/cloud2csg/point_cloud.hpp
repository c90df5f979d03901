#pragma once

#include <cstddef>
#include <filesystem>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Points with outward unit normals, as structure of arrays.
/// Invariant: `normals` is empty or has as many entries as `positions`.
struct PointCloud {
  Points positions = {};
  Points normals = {};

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool has_normals() const { return !normals.empty(); }
};

/// Reads .ply (ascii, binary little and big endian), .pcd (ascii, binary, binary_compressed), and as text .xyz and .txt
/// (3 columns, or 6 with normals), .xyzn (6) and .pts (count, then 3, 4 or 7); the format follows the file's ending.
/// Coordinates may be of any numeric type; other properties, lists and elements are skipped, in text so are
/// lines that start with # or //. Normals are brought to unit length; those that have it keep their bits.
/// O(n); 10 million points take seconds.
/// @throws Error naming the file and line or byte: missing or unreadable file, unknown ending, wrong or truncated
/// header or data, no points, a coordinate that is not finite, a normal of length zero. Cancelled.
[[nodiscard]] PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run = {});

struct CloudWriteOptions {
  bool binary = true;            ///< .ply and .pcd; the others are text always
  bool double_precision = true;  ///< keeps every bit, in text too; false: float, a file of half the size
};

/// Writes by the file's ending, as read_point_cloud reads; .pts has no place for normals and leaves them out, .xyzn
/// needs them. Nothing half-written: a temporary file, then a rename. O(n)
/// @throws Error when the file cannot be written, the disk is full, the ending is unknown, or a number is not finite.
void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                       const CloudWriteOptions& options = {});

}  // namespace cloud2csg
