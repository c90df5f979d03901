#include "cloud2csg/point_cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/atomic_file.hpp"
#include "core/base/file_ending.hpp"
#include "io/clouds/file_content.hpp"
#include "io/clouds/formats.hpp"

namespace cloud2csg {
namespace {

struct CloudFormat {
  std::string_view ending;
  PointCloud (*read)(const FileContent&, InvalidPoints, const RunContext&);
  void (*write)(AtomicFile&, const PointCloud&, const CloudWriteOptions&);
  bool needs_normals = false;
};

constexpr std::array<CloudFormat, 6> k_formats{{
    {".ply", read_ply, write_ply},
    {".pcd", read_pcd, write_pcd},
    {".xyz", read_xyz, write_xyz},
    {".xyzn", read_xyzn, write_xyz, true},
    {".txt", read_xyz, write_xyz},
    {".pts", read_pts, write_pts},
}};

const CloudFormat& format_of(const std::filesystem::path& file) {
  const std::string ending = lower_ending(file);
  const auto* const found = std::ranges::find(k_formats, ending, &CloudFormat::ending);
  if (found != k_formats.end()) return *found;
  throw Error({.file = file.string(),
               .where = {},
               .expected = "expected a point cloud with ending .ply, .pcd, .xyz, .xyzn, .txt or .pts",
               .remedy = "rename or convert the file"});
}

}  // namespace

PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run) {
  const CloudFormat& format = format_of(file);
  return format.read(FileContent(file, run), InvalidPoints::refuse, run);
}

RawCloud read_raw_cloud(const std::filesystem::path& file, const RunContext& run) {
  const CloudFormat& format = format_of(file);
  const FileContent content(file, run);
  RawCloud raw{.cloud = format.read(content, InvalidPoints::keep, run)};
  const std::size_t count = raw.cloud.size();
  if (raw.cloud.has_normals()) {
    for (std::size_t i = 0; i < count; ++i) raw.invalid_normals += raw.cloud.normals[i].isZero(0.0) ? 1 : 0;
    raw.normals_left_out = 2 * raw.invalid_normals > count;
    if (raw.normals_left_out) raw.cloud.normals = {};
  }
  std::vector<std::uint32_t> valid;
  for (std::size_t i = 0; i < count; ++i) {
    const bool has_direction = !raw.cloud.has_normals() || !raw.cloud.normals[i].isZero(0.0);
    if (raw.cloud.positions[i].allFinite() && has_direction) valid.push_back(static_cast<std::uint32_t>(i));
  }
  if (valid.empty()) content.fail(fmt::format("expected finite coordinates, all {} points have others", count));
  raw.invalid_points = count - valid.size();
  if (raw.invalid_points > 0) raw.cloud = select_points(raw.cloud, valid);
  return raw;
}

void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud, const CloudWriteOptions& options) {
  assert(!cloud.has_normals() || cloud.normals.size() == cloud.positions.size());
  assert(!cloud.has_sensor_positions() || cloud.sensor_positions.size() == cloud.positions.size());
  assert(options.colours.empty() || options.colours.size() == cloud.positions.size());
  const CloudFormat& format = format_of(file);
  if (format.needs_normals && !cloud.has_normals()) {
    throw Error({.file = file.string(),
                 .where = {},
                 .expected = "a file of this ending holds normals, the cloud has none",
                 .remedy = "write .xyz, or estimate the normals first"});
  }
  AtomicFile out(file);
  try {
    format.write(out, cloud, options);
  } catch (const Error& error) {
    if (!error.parts().file.empty()) throw;
    Error::Parts parts = error.parts();
    parts.file = file.string();
    throw Error(std::move(parts));
  }
  out.commit();
}

}  // namespace cloud2csg
