#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/formats.hpp"
#include "io/clouds/lzf.hpp"
#include "io/clouds/pcd_header.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {
namespace {

PointLayout find_fields(const FileContent& content, const PcdHeader& header) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) {
    names.push_back(field.count == 1 ? field.name : std::string());  // a coordinate is one number
  }
  return find_layout(content, {FilePosition::Unit::line, header.fields_line}, names);
}

/// The same layout, in columns of text instead of fields.
PointLayout columns_of(const PcdHeader& header, const PointLayout& layout) {
  std::vector<std::size_t> first_column;
  std::size_t column = 0;
  for (const PcdField& field : header.fields) {
    first_column.push_back(column);
    column += field.count;
  }
  return layout.map([&](const std::array<std::size_t, 3>& fields) {
    return std::array{first_column[fields[0]], first_column[fields[1]], first_column[fields[2]]};
  });
}

Eigen::Vector3d pick(std::span<const double> row, const std::array<std::size_t, 3>& columns) {
  return {row[columns[0]], row[columns[1]], row[columns[2]]};
}

PointCloud read_ascii(const FileContent& content, const PcdHeader& header, const PointLayout& fields,
                      InvalidPoints invalid, const RunContext& run) {
  const PointLayout layout = columns_of(header, fields);
  TextRows rows(content, header.data_offset, header.line_count);
  CloudAssembly assembly(content, header.points, std::min(header.points, rows.bytes_left() / 6 + 1), invalid, run);
  while (const std::optional<std::span<const double>> row = rows.next_row()) {
    if (row->size() != header.columns()) {
      content.fail(rows.where(),
                   fmt::format("expected {} columns as the header announces, found {}", header.columns(), row->size()));
    }
    if (assembly.size() == header.points) {
      content.fail(rows.where(), fmt::format("expected no more than the announced {} points", header.points));
    }
    assembly.add(layout.map([&](const auto& columns) { return pick(*row, columns); }), rows.where());
  }
  if (assembly.size() < header.points) content.fail_truncated(rows.where(), header.points, assembly.size());
  return std::move(assembly).finish();
}

/// Columns of the fields: in records side by side, or (compressed) one whole field after another.
CloudColumns columns_at(const PcdHeader& header, const PointLayout& layout, const char* data, bool field_after_field) {
  std::vector<BinaryColumn> columns;
  const std::size_t stride = header.stride();
  for (const PcdField& field : header.fields) {
    columns.push_back({.base = data,
                       .stride = field_after_field ? field.bytes() : stride,
                       .type = field.type,
                       .order = std::endian::little});
    data += field_after_field ? field.bytes() * header.points : field.bytes();
  }
  return layout.map([&](const std::array<std::size_t, 3>& fields) {
    return std::array{columns[fields[0]], columns[fields[1]], columns[fields[2]]};
  });
}

PointCloud read_binary(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                       InvalidPoints invalid, const RunContext& run) {
  const std::size_t stride = header.stride();
  const std::size_t found = (content.bytes().size() - header.data_offset) / stride;
  if (found < header.points) {
    content.fail_truncated({FilePosition::Unit::byte, header.data_offset + found * stride}, header.points, found);
  }
  const char* const data = content.bytes().data() + header.data_offset;
  return cloud_of_columns(
      content, columns_at(header, layout, data, false), header.points,
      [&](std::size_t i) { return header.data_offset + i * stride; }, invalid, run);
}

PointCloud read_compressed(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                           InvalidPoints invalid, const RunContext& run) {
  const FilePosition where{FilePosition::Unit::byte, header.data_offset};
  constexpr std::size_t k_size_bytes = 2 * sizeof(std::uint32_t);
  const std::string_view data = content.bytes().substr(header.data_offset);
  if (data.size() < k_size_bytes) content.fail_truncated(where, header.points, 0);
  const std::size_t compressed_size = load<std::uint32_t>(data.data(), std::endian::little);
  const std::size_t size = load<std::uint32_t>(data.data() + sizeof(std::uint32_t), std::endian::little);
  if (size != header.points * header.stride()) {
    content.fail(where, fmt::format("expected {} bytes of data for the announced {} points, found {}",
                                    header.points * header.stride(), header.points, size));
  }
  if (data.size() - k_size_bytes < compressed_size) {
    content.fail(where,
                 fmt::format("the file announces {} points in {} compressed bytes but ends after {} bytes",
                             header.points, compressed_size, data.size() - k_size_bytes),
                 k_copy_again);
  }
  const std::optional<std::string> records = decompress_lzf(data.substr(k_size_bytes, compressed_size), size);
  if (!records) content.fail(where, "the compressed data is damaged", k_copy_again);
  return cloud_of_columns(
      content, columns_at(header, layout, records->data(), true), header.points,
      [&](std::size_t) { return header.data_offset; }, invalid, run);
}

PointCloud read_data(const FileContent& content, const PcdHeader& header, const PointLayout& layout,
                     InvalidPoints invalid, const RunContext& run) {
  switch (header.data) {
    case PcdData::ascii:
      return read_ascii(content, header, layout, invalid, run);
    case PcdData::binary:
      return read_binary(content, header, layout, invalid, run);
    case PcdData::binary_compressed:
      break;
  }
  return read_compressed(content, header, layout, invalid, run);
}

}  // namespace

PointCloud read_pcd(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  const PcdHeader header = parse_pcd_header(content);
  PointCloud cloud = read_data(content, header, find_fields(content, header), invalid, run);
  if (header.sensor_position && !cloud.has_sensor_positions()) {
    cloud.sensor_positions.resize(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) cloud.sensor_positions.set(i, *header.sensor_position);
  }
  return cloud;
}

}  // namespace cloud2csg
