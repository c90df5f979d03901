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
#include "core/base/files.hpp"
#include "io/clouds/file_content.hpp"
#include "io/clouds/formats.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg {
namespace {

struct CloudFormat {
  FileFormat::Id id;
  PointCloud (*read)(const FileContent&, InvalidPoints, const RunContext&);
  void (*write)(AtomicFile&, const PointCloud&, const CloudWriteOptions&);
};

constexpr std::array<CloudFormat, 5> k_formats{{
    {FileFormat::Id::ply, read_ply, write_ply},
    {FileFormat::Id::pcd, read_pcd, write_pcd},
    {FileFormat::Id::xyz, read_xyz, write_xyz},
    {FileFormat::Id::xyzn, read_xyzn, write_xyz},
    {FileFormat::Id::pts, read_pts, write_pts},
}};

const CloudFormat& cloud_format(FileFormat::Id id) {
  return *std::ranges::find(k_formats, id, &CloudFormat::id);
}

}  // namespace

PointCloud read_point_cloud(const std::filesystem::path& file, const RunContext& run) {
  const CloudFormat& format = cloud_format(format_to_read(file, {FileKind::cloud}).format);
  return format.read(FileContent(file, run), InvalidPoints::refuse, run);
}

RawCloud read_raw_cloud(const std::filesystem::path& file, const RunContext& run) {
  const CloudFormat& format = cloud_format(format_to_read(file, {FileKind::cloud}).format);
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
  if (valid.empty()) content.fail(fmt::format("expected finite coordinates, found none in {} points", count));
  raw.invalid_points = count - valid.size();
  if (raw.invalid_points > 0) raw.cloud = select_points(raw.cloud, valid);
  return raw;
}

void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud, const CloudWriteOptions& options) {
  assert(!cloud.has_normals() || cloud.normals.size() == cloud.positions.size());
  assert(!cloud.has_sensor_positions() || cloud.sensor_positions.size() == cloud.positions.size());
  assert(options.colours.empty() || options.colours.size() == cloud.positions.size());
  const CloudFormat& format = cloud_format(format_to_write(file, {FileKind::cloud}));
  if (format.id == FileFormat::Id::xyzn && !cloud.has_normals()) {
    throw Error({.file = file.string(),
                 .expected = "files with this ending need normals, and the cloud has none",
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
