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
  /// Position of the sensor that saw each point. The surface faces it, and the line between is empty.
  Points sensor_positions = {};

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool has_normals() const { return !normals.empty(); }
  [[nodiscard]] bool has_sensor_positions() const { return !sensor_positions.empty(); }
};

/// Reads a cloud by the file's ending: .ply (ascii, binary little and big endian), .pcd (ascii, binary,
/// binary_compressed), and as text .xyz and .txt (3 columns, or 6 with normals), .xyzn (6) and .pts (count, then 3, 4
/// or 7). Coordinates may be of any numeric type. Other properties, lists, elements, and text lines that start with #
/// or // are skipped. Sensor positions are the properties sensor_x, sensor_y, sensor_z (or vp_x, vp_y, vp_z) of .ply
/// and .pcd, or the VIEWPOINT of a .pcd for all its points. The default VIEWPOINT 0 0 0 1 0 0 0 counts as none. Normals
/// are scaled to unit length; unit normals keep their bits. O(n); 10 million points take seconds.
/// @throws Error naming the file and line or byte: missing or unreadable file, unknown ending, wrong or truncated
/// header or data, no points, a coordinate or sensor position that is not finite, a normal of length zero. Cancelled.
[[nodiscard]] PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run = {});

/// The valid part of a raw cloud, and counts of the invalid rest.
struct RawCloud {
  PointCloud cloud;
  std::size_t invalid_points = 0;   ///< left out: a coordinate is not finite, or the normal has no direction
  bool normals_left_out = false;    ///< all normals were left out because more than half were invalid
  std::size_t invalid_normals = 0;  ///< number of invalid normals when normals_left_out
};

/// As read_point_cloud(), but leaves out and counts points that scanners mark as missing (NaN, infinite, a normal of
/// length zero) instead of refusing them. Where most normals are invalid, it keeps the points without normals. O(n)
/// @throws Error as read_point_cloud() for anything else, and when no valid point is left; Cancelled.
[[nodiscard]] RawCloud read_raw_cloud(const std::filesystem::path& file, const RunContext& run = {});

/// The points with these indices, in this order, with normals and sensor positions. O(indices)
[[nodiscard]] PointCloud select_points(const PointCloud& cloud, std::span<const std::uint32_t> indices);

struct CloudWriteOptions {
  bool binary = true, double_precision = true;
  /// One colour per point, or none. Only .ply stores them, as red, green and blue.
  std::span<const Colour> colours = {};
};
void option_table(OptionsOf<CloudWriteOptions>, auto&& field) {
  using O = CloudWriteOptions;
  field(&O::binary, "binary", "Write binary numbers in .ply and .pcd; other formats are always text",
        {.opposite = "ascii", .otherwise = "Write text instead of binary numbers in .ply and .pcd"});
  field(&O::double_precision, "double_precision",
        "Keep all bits, in text too; false: single precision, which halves the size of the file", k_library);
}

/// Writes by the file's ending, as read_point_cloud() reads. .pts leaves out normals, .xyzn needs them. .ply and .pcd
/// store sensor positions (.pcd as VIEWPOINT when all are equal and not the origin); text formats leave them out. Never
/// leaves a partial file: writes a temporary file, then renames it. O(n)
/// @throws Error when the file cannot be written, the disk is full, the ending is unknown, or a number is not finite.
void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                       const CloudWriteOptions& options = {});

}  // namespace cloud2csg
