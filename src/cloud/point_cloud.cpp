#include "cloud2csg/point_cloud.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "base/atomic_file.hpp"
#include "cloud/file_content.hpp"
#include "cloud/formats.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

struct CloudFormat {
  std::string_view ending;
  PointCloud (*read)(const FileContent&, const RunContext&);
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
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
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
  return format.read(FileContent(file, run), run);
}

void write_point_cloud(const std::filesystem::path& file, const PointCloud& cloud, const CloudWriteOptions& options) {
  assert(!cloud.has_normals() || cloud.normals.size() == cloud.positions.size());
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
