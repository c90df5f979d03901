#include <fmt/format.h>

#include <algorithm>

#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/formats.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_plain_columns = 3;
constexpr std::size_t k_normal_columns = 6;
/// An estimate for reserving memory, not a bound.
constexpr std::size_t k_typical_number_bytes = 12;

void add_row(CloudAssembly& assembly, std::span<const double> row, bool with_normals, FilePosition where) {
  CloudPoint point{.position = {row[0], row[1], row[2]}};
  if (with_normals) point.normal = Eigen::Vector3d(row[3], row[4], row[5]);
  assembly.add(point, where);
}

/// Reads rows of equal length to the end of the file. The caller has read the first row.
PointCloud read_rows(const FileContent& content, TextRows& rows, std::span<const double> first, InvalidPoints invalid,
                     const RunContext& run) {
  const std::size_t columns = first.size();
  const bool with_normals = columns == k_normal_columns;
  CloudAssembly assembly(content, 0, rows.bytes_left() / (columns * k_typical_number_bytes) + 1, invalid, run);
  add_row(assembly, first, with_normals, rows.where());
  while (const std::optional<std::span<const double>> row = rows.next_row()) {
    if (row->size() != columns) {
      content.fail(rows.where(),
                   fmt::format("expected {} columns as in the rows before, found {}", columns, row->size()));
    }
    add_row(assembly, *row, with_normals, rows.where());
  }
  return std::move(assembly).finish();
}

}  // namespace

PointCloud read_xyz(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  TextRows rows(content);
  const std::optional<std::span<const double>> first = rows.next_row();
  if (!first) content.fail("holds no points");
  if (first->size() != k_plain_columns && first->size() != k_normal_columns) {
    content.fail(rows.where(), fmt::format("expected 3 columns (x y z) or 6 (x y z nx ny nz), found {}", first->size()),
                 "remove other columns");
  }
  return read_rows(content, rows, *first, invalid, run);
}

PointCloud read_xyzn(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  TextRows rows(content);
  const std::optional<std::span<const double>> first = rows.next_row();
  if (!first) content.fail("holds no points");
  if (first->size() != k_normal_columns) {
    content.fail(rows.where(), fmt::format("expected 6 columns (x y z nx ny nz), found {}", first->size()));
  }
  return read_rows(content, rows, *first, invalid, run);
}

PointCloud read_pts(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  TextRows rows(content);
  const std::optional<std::string_view> first_line = rows.next_line();
  if (!first_line) content.fail("holds no points");
  const std::optional<std::size_t> announced = parse_count(*first_line);
  if (!announced) content.fail(rows.where(), "expected the number of points, alone in the first line");
  CloudAssembly assembly(content, *announced,
                         std::min(*announced, rows.bytes_left() / (3 * k_typical_number_bytes) + 1), invalid, run);
  while (const std::optional<std::span<const double>> row = rows.next_row()) {
    const std::size_t columns = row->size();
    if (columns != 3 && columns != 4 && columns != 7) {
      content.fail(rows.where(),
                   fmt::format("expected 3, 4 or 7 columns (x y z, intensity, red green blue), found {}", columns));
    }
    if (assembly.size() == *announced) {
      content.fail(rows.where(), fmt::format("expected no more than the announced {} points", *announced));
    }
    add_row(assembly, *row, false, rows.where());
  }
  if (assembly.size() < *announced) content.fail_truncated(rows.where(), *announced, assembly.size());
  return std::move(assembly).finish();
}

}  // namespace cloud2csg
