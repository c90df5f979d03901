#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "cloud2csg/advanced/colour.hpp"
#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// Points with outward unit normals, as structure of arrays.
/// Invariant: `normals` and `sensor_positions` are each empty or have as many entries as `positions`.
struct PointCloud {
  Points positions = {};
  Points normals = {};
  /// Where the sensor stood that saw the point, in units of the world: the surface faces that way, and between the two
  /// there is nothing.
  Points sensor_positions = {};

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool has_normals() const { return !normals.empty(); }
  [[nodiscard]] bool has_sensor_positions() const { return !sensor_positions.empty(); }
};

/// Reads .ply (ascii, binary little and big endian), .pcd (ascii, binary, binary_compressed), and as text .xyz and .txt
/// (3 columns, or 6 with normals), .xyzn (6) and .pts (count, then 3, 4 or 7); the format follows the file's ending.
/// Coordinates may be of any numeric type; other properties, lists and elements are skipped, in text so are
/// lines that start with # or //. Sensor positions are the properties sensor_x, sensor_y, sensor_z (or vp_x, vp_y,
/// vp_z) of .ply and .pcd, or the VIEWPOINT of a .pcd for all its points; one that is 0 0 0 1 0 0 0 is what programs
/// write that do not know, and is taken for none. Normals are brought to unit length; those that have it keep their
/// bits. O(n); 10 million points take seconds.
/// @throws Error naming the file and line or byte: missing or unreadable file, unknown ending, wrong or truncated
/// header or data, no points, a coordinate or sensor position that is not finite, a normal of length zero. Cancelled.
[[nodiscard]] PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run = {});

/// What is left of a raw cloud, and what had to be left out.
struct RawCloud {
  PointCloud cloud;
  std::size_t invalid_points = 0;   ///< left out: a coordinate that is not finite, or no direction for a normal
  bool normals_left_out = false;    ///< more than half of the normals were invalid, so all were left out
  std::size_t invalid_normals = 0;  ///< ... and so many of them were
};

/// As read_point_cloud(), but points that scanners mark as missing (NaN, infinite, a normal of length zero) are left
/// out and counted instead of refused. Where most normals are invalid the points stay, without normals. O(n)
/// @throws Error as read_point_cloud() for anything else, and when no valid point is left; Cancelled.
[[nodiscard]] RawCloud read_raw_cloud(const std::filesystem::path& file, const RunContext& run = {});

/// The points with these indices, in this order, with all that is known of them. O(indices)
[[nodiscard]] PointCloud select_points(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// Its fields: see the table.
struct CloudWriteOptions {
  bool binary = true, double_precision = true;
  /// One a point, or none: red, green and blue in .ply; the others leave them out.
  std::span<const Colour> colours = {};
};
void option_table(OptionsOf<CloudWriteOptions>, auto&& field) {
  using O = CloudWriteOptions;
  field(&O::binary, "binary", "Binary numbers in .ply and .pcd; the others are text always",
        {.opposite = "ascii", .otherwise = "Text instead of binary numbers in .ply and .pcd"});
  field(&O::double_precision, "double_precision",
        "Keep every bit, in text too; else single precision, a file of half the size", k_library);
}

/// Writes by the file's ending, as read_point_cloud reads; .pts has no place for normals and leaves them out, .xyzn
/// needs them. Sensor positions are written to .ply and .pcd (as VIEWPOINT, where they are all the same and not the
/// origin), text leaves them out. Nothing half-written: a temporary file, then a rename. O(n)
/// @throws Error when the file cannot be written, the disk is full, the ending is unknown, or a number is not finite.
void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                       const CloudWriteOptions& options = {});

}  // namespace cloud2csg
