#include <fmt/format.h>

#include <string>

#include "cloud/formats.hpp"
#include "cloud/record_writer.hpp"

namespace cloud2csg {

void write_ply(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  const char* const type = options.double_precision ? "double" : "float";
  std::string header = fmt::format("ply\nformat {} 1.0\nelement vertex {}\n",
                                   options.binary ? "binary_little_endian" : "ascii", cloud.size());
  for (const char* name : {"x", "y", "z"}) header += fmt::format("property {} {}\n", type, name);
  if (cloud.has_normals()) {
    for (const char* name : {"nx", "ny", "nz"}) header += fmt::format("property {} {}\n", type, name);
  }
  out.write(header + "end_header\n");
  write_records(
      out, cloud,
      {.binary = options.binary, .double_precision = options.double_precision, .normals = cloud.has_normals()});
}

void write_pcd(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  const std::size_t columns = cloud.has_normals() ? 6 : 3;
  const auto for_each_column = [columns](const char* word) {
    std::string words;
    for (std::size_t i = 0; i < columns; ++i) words += word;
    return words;
  };
  out.write("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n");
  out.write(cloud.has_normals() ? "FIELDS x y z normal_x normal_y normal_z\n" : "FIELDS x y z\n");
  out.write(fmt::format("SIZE{}\nTYPE{}\nCOUNT{}\n", for_each_column(options.double_precision ? " 8" : " 4"),
                        for_each_column(" F"), for_each_column(" 1")));
  out.write(fmt::format("WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA {1}\n", cloud.size(),
                        options.binary ? "binary" : "ascii"));
  write_records(
      out, cloud,
      {.binary = options.binary, .double_precision = options.double_precision, .normals = cloud.has_normals()});
}

void write_xyz(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  write_records(out, cloud,
                {.binary = false, .double_precision = options.double_precision, .normals = cloud.has_normals()});
}

void write_pts(AtomicFile& out, const PointCloud& cloud, const CloudWriteOptions& options) {
  out.write(fmt::format("{}\n", cloud.size()));
  write_records(out, cloud, {.binary = false, .double_precision = options.double_precision, .normals = false});
}

}  // namespace cloud2csg
