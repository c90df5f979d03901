#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "core/base/files.hpp"
#include "io/clouds/formats.hpp"

namespace cloud2csg {
namespace {

/// Which numbers a point has in the file, and how they are written.
struct RecordFormat {
  bool binary;                           ///< little endian; else text, a row a point, with the shortest exact decimals
  bool double_precision;                 ///< else float
  bool normals;                          ///< after the coordinates
  bool sensor_positions;                 ///< after the normals
  std::span<const Colour> colours = {};  ///< one a point, after all numbers, as three bytes
};

constexpr std::size_t k_bytes_a_write = std::size_t{1} << 20;

template <typename T>
void append_binary(std::string& block, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  block.append(raw.data(), raw.size());
}

template <typename T>
void append_text(std::string& block, T value, char separator) {
  std::array<char, 32> digits;
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  block.append(digits.data(), end);
  block += separator;
}

template <typename T>
void append_record(std::string& block, std::span<const double> numbers, bool binary) {
  for (const double& number : numbers) {
    const T value = static_cast<T>(number);
    if (!std::isfinite(value)) {
      throw Error({.expected = fmt::format("expected finite numbers to write, found {}", number),
                   .remedy = sizeof(T) < sizeof(double) ? "write in double precision" : ""});
    }
    if (binary) {
      append_binary(block, value);
    } else {
      append_text(block, value, &number == &numbers.back() ? '\n' : ' ');
    }
  }
}

void append_colour(std::string& block, const Colour& colour, bool binary) {
  if (binary) {
    for (const std::uint8_t value : {colour.red, colour.green, colour.blue}) append_binary(block, value);
    return;
  }
  block.back() = ' ';  // replaces the line end
  block += fmt::format("{} {} {}\n", colour.red, colour.green, colour.blue);
}

/// Writes all points in large blocks. @throws Error for a number that is not finite or out of a float's range.
void write_records(AtomicFile& out, const PointCloud& cloud, const RecordFormat& format) {
  std::string block;
  std::array<double, 9> numbers{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    auto end = std::copy_n(cloud.positions[i].data(), 3, numbers.begin());
    if (format.normals) end = std::copy_n(cloud.normals[i].data(), 3, end);
    if (format.sensor_positions) end = std::copy_n(cloud.sensor_positions[i].data(), 3, end);
    const std::span<const double> used(numbers.begin(), end);
    if (format.double_precision) {
      append_record<double>(block, used, format.binary);
    } else {
      append_record<float>(block, used, format.binary);
    }
    if (!format.colours.empty()) append_colour(block, format.colours[i], format.binary);
    if (block.size() >= k_bytes_a_write) {
      out.write(block);
      block.clear();
    }
  }
  out.write(block);
}

/// The sensor position of all points. Absent if they differ or lie at the origin, where VIEWPOINT means "unknown".
std::optional<Eigen::Vector3d> common_sensor_position(const PointCloud& cloud) {
  if (!cloud.has_sensor_positions()) return std::nullopt;
  const Eigen::Vector3d first = cloud.sensor_positions[0];
  if (first.isZero(0.0) || !first.allFinite()) return std::nullopt;
  for (std::size_t i = 1; i < cloud.size(); ++i) {
    if (cloud.sensor_positions[i] != first) return std::nullopt;
  }
  return first;
}

}  // namespace

void write_ply(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  std::vector<std::string_view> names{"x", "y", "z"};
  if (cloud.has_normals()) names.insert(names.end(), {"nx", "ny", "nz"});
  if (cloud.has_sensor_positions()) names.insert(names.end(), {"sensor_x", "sensor_y", "sensor_z"});
  const char* const type = options.double_precision ? "double" : "float";
  std::string header = fmt::format("ply\nformat {} 1.0\nelement vertex {}\n",
                                   options.binary ? "binary_little_endian" : "ascii", cloud.size());
  for (const std::string_view name : names) header += fmt::format("property {} {}\n", type, name);
  if (!options.colours.empty()) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  out.write(header + "end_header\n");
  write_records(out, cloud,
                {.binary = options.binary,
                 .double_precision = options.double_precision,
                 .normals = cloud.has_normals(),
                 .sensor_positions = cloud.has_sensor_positions(),
                 .colours = options.colours});
}

void write_pcd(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  const std::optional<Eigen::Vector3d> viewpoint = common_sensor_position(cloud);
  const bool with_sensors = cloud.has_sensor_positions() && !viewpoint;
  std::vector<std::string_view> names{"x", "y", "z"};
  if (cloud.has_normals()) names.insert(names.end(), {"normal_x", "normal_y", "normal_z"});
  if (with_sensors) names.insert(names.end(), {"sensor_x", "sensor_y", "sensor_z"});
  const auto for_each_column = [&](std::string_view word) {
    std::string words;
    for (std::size_t i = 0; i < names.size(); ++i) words += word;
    return words;
  };
  out.write("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n");
  out.write(fmt::format("FIELDS {}\nSIZE{}\nTYPE{}\nCOUNT{}\n", fmt::join(names, " "),
                        for_each_column(options.double_precision ? " 8" : " 4"), for_each_column(" F"),
                        for_each_column(" 1")));
  const Eigen::Vector3d position = viewpoint.value_or(Eigen::Vector3d::Zero());
  out.write(fmt::format("WIDTH {0}\nHEIGHT 1\nVIEWPOINT {1} {2} {3} 1 0 0 0\nPOINTS {0}\nDATA {4}\n", cloud.size(),
                        position.x(), position.y(), position.z(), options.binary ? "binary" : "ascii"));
  write_records(out, cloud,
                {.binary = options.binary,
                 .double_precision = options.double_precision,
                 .normals = cloud.has_normals(),
                 .sensor_positions = with_sensors});
}

void write_xyz(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  write_records(out, cloud,
                {.binary = false,
                 .double_precision = options.double_precision,
                 .normals = cloud.has_normals(),
                 .sensor_positions = false});
}

void write_pts(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  out.write(fmt::format("{}\n", cloud.size()));
  write_records(
      out, cloud,
      {.binary = false, .double_precision = options.double_precision, .normals = false, .sensor_positions = false});
}

}  // namespace cloud2csg
