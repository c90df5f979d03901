#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/formats.hpp"
#include "io/clouds/ply_header.hpp"
#include "io/clouds/text_rows.hpp"

namespace cloud2csg {
namespace {

struct VertexElement {
  std::size_t index;  ///< among the elements of the file
  PointLayout layout;
};

VertexElement find_vertices(const FileContent& content, const PlyHeader& header) {
  const auto vertices = std::find_if(header.elements.begin(), header.elements.end(),
                                     [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertices == header.elements.end()) {
    content.fail({FilePosition::Unit::line, header.line_count}, "expected an element \"vertex\" in the header");
  }
  std::vector<std::string> names;
  for (const PlyProperty& property : vertices->properties) {
    names.push_back(property.list_count ? std::string() : property.name);  // a list is no coordinate
  }
  return {.index = static_cast<std::size_t>(vertices - header.elements.begin()),
          .layout = find_layout(content, {FilePosition::Unit::line, vertices->header_line}, names)};
}

/// A list's number of entries as a file gives it; absent when it is not a whole number in reach.
std::optional<std::size_t> list_length(double count, std::size_t longest) {
  if (!(count >= 0.0) || count > static_cast<double>(longest) || count != std::floor(count)) return std::nullopt;
  return static_cast<std::size_t>(count);
}

/// Column of each property in a row of an ascii file; empty when the row does not have what the element wants.
std::vector<std::size_t> columns_in_row(const PlyElement& element, std::span<const double> row) {
  std::vector<std::size_t> columns;
  std::size_t column = 0;
  for (const PlyProperty& property : element.properties) {
    if (column >= row.size()) return {};
    columns.push_back(column);
    if (property.list_count) {
      const std::optional<std::size_t> length = list_length(row[column], row.size());
      if (!length) return {};
      column += *length;
    }
    ++column;
  }
  if (column != row.size()) columns.clear();
  return columns;
}

Eigen::Vector3d pick(std::span<const double> row, std::span<const std::size_t> columns,
                     const std::array<std::size_t, 3>& properties) {
  return {row[columns[properties[0]]], row[columns[properties[1]]], row[columns[properties[2]]]};
}

PointCloud read_ascii(const FileContent& content, const PlyHeader& header, const VertexElement& vertices,
                      InvalidPoints invalid, const RunContext& run) {
  TextRows rows(content, header.data_offset, header.line_count);
  for (std::size_t before = 0; before < vertices.index; ++before) {
    for (std::size_t i = 0; i < header.elements[before].count; ++i) {
      if (!rows.next_line()) fail_truncated(content, rows.where(), header.elements[vertices.index].count, 0);
    }
  }
  const PlyElement& element = header.elements[vertices.index];
  const PointLayout& layout = vertices.layout;
  CloudAssembly assembly(content, element.count, std::min(element.count, rows.bytes_left() / 6 + 1), invalid, run);
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < element.count; ++i) {
    const std::optional<std::span<const double>> row = rows.next_row();
    if (!row) fail_truncated(content, rows.where(), element.count, i);
    if (i == 0 || element.has_lists() || row->size() != element.properties.size()) {
      columns = columns_in_row(element, *row);
      if (columns.empty()) {
        content.fail(rows.where(), fmt::format("expected the {} properties that the header announces, found {} columns",
                                               element.properties.size(), row->size()));
      }
    }
    assembly.add(layout.map([&](const auto& properties) { return pick(*row, columns, properties); }), rows.where());
  }
  return std::move(assembly).finish();
}

/// Walks over binary records whose length is only known from the lists in them.
class RecordWalker {
 public:
  RecordWalker(const FileContent& content, std::size_t offset, std::endian order)
      : content_(content), offset_(offset), order_(order) {}

  [[nodiscard]] std::size_t offset() const { return offset_; }

  /// Steps over a record. The byte of each of its properties stays in starts(). False when the file ends in it.
  bool step(const PlyElement& element) {
    starts_.clear();
    for (const PlyProperty& property : element.properties) {
      starts_.push_back(offset_);
      std::size_t bytes = size_of(property.type);
      if (property.list_count) {
        const std::size_t count_bytes = size_of(*property.list_count);
        if (bytes_left() < count_bytes) return false;
        const double count = decode(content_.bytes().data() + offset_, *property.list_count, order_);
        offset_ += count_bytes;
        const std::optional<std::size_t> length = list_length(count, bytes_left() / bytes);
        if (!length) return false;
        bytes *= *length;
      }
      if (bytes_left() < bytes) return false;
      offset_ += bytes;
    }
    return true;
  }

  /// Steps over all records of an element. @returns how many there are, at most element.count.
  std::size_t step_over(const PlyElement& element) {
    if (!element.has_lists()) {
      const std::size_t stride = element.stride();
      const std::size_t found = stride == 0 ? element.count : std::min(element.count, bytes_left() / stride);
      offset_ += found * stride;
      return found;
    }
    std::size_t found = 0;
    while (found < element.count && step(element)) ++found;
    return found;
  }

  [[nodiscard]] double value(const PlyElement& element, std::size_t property) const {
    return decode(content_.bytes().data() + starts_[property], element.properties[property].type, order_);
  }
  [[nodiscard]] Eigen::Vector3d vector(const PlyElement& element, const std::array<std::size_t, 3>& properties) const {
    return {value(element, properties[0]), value(element, properties[1]), value(element, properties[2])};
  }

 private:
  [[nodiscard]] std::size_t bytes_left() const { return content_.bytes().size() - offset_; }

  const FileContent& content_;
  std::size_t offset_;
  std::endian order_;
  std::vector<std::size_t> starts_;
};

PointCloud read_varying_records(const FileContent& content, const PlyElement& element, const PointLayout& layout,
                                RecordWalker walker, InvalidPoints invalid, const RunContext& run) {
  CloudAssembly assembly(content, element.count, std::min(element.count, content.bytes().size() / 4), invalid, run);
  for (std::size_t i = 0; i < element.count; ++i) {
    const FilePosition where{FilePosition::Unit::byte, walker.offset()};
    if (!walker.step(element)) fail_truncated(content, where, element.count, i);
    assembly.add(layout.map([&](const auto& properties) { return walker.vector(element, properties); }), where);
  }
  return std::move(assembly).finish();
}

PointCloud read_equal_records(const FileContent& content, const PlyElement& element, const PointLayout& layout,
                              std::size_t offset, std::endian order, InvalidPoints invalid, const RunContext& run) {
  const std::size_t stride = element.stride();
  const std::size_t found = (content.bytes().size() - offset) / stride;
  if (found < element.count) {
    fail_truncated(content, {FilePosition::Unit::byte, offset + found * stride}, element.count, found);
  }
  std::vector<std::size_t> property_offsets;
  std::size_t property_offset = offset;
  for (const PlyProperty& property : element.properties) {
    property_offsets.push_back(property_offset);
    property_offset += size_of(property.type);
  }
  const auto columns_of = [&](const std::array<std::size_t, 3>& properties) {
    std::array<BinaryColumn, 3> columns;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t property = properties[axis];
      columns[axis] = {.base = content.bytes().data() + property_offsets[property],
                       .stride = stride,
                       .type = element.properties[property].type,
                       .order = order};
    }
    return columns;
  };
  return cloud_of_columns(
      content, layout.map(columns_of), element.count, [&](std::size_t i) { return offset + i * stride; }, invalid, run);
}

PointCloud read_binary(const FileContent& content, const PlyHeader& header, const VertexElement& vertices,
                       InvalidPoints invalid, const RunContext& run) {
  const std::endian order = header.format == PlyFormat::binary_little_endian ? std::endian::little : std::endian::big;
  const PlyElement& element = header.elements[vertices.index];
  RecordWalker walker(content, header.data_offset, order);
  for (std::size_t before = 0; before < vertices.index; ++before) {
    if (walker.step_over(header.elements[before]) < header.elements[before].count) {
      fail_truncated(content, {FilePosition::Unit::byte, walker.offset()}, element.count, 0);
    }
  }
  return element.has_lists()
             ? read_varying_records(content, element, vertices.layout, walker, invalid, run)
             : read_equal_records(content, element, vertices.layout, walker.offset(), order, invalid, run);
}

}  // namespace

PointCloud read_ply(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  const PlyHeader header = parse_ply_header(content);
  const VertexElement vertices = find_vertices(content, header);
  return header.format == PlyFormat::ascii ? read_ascii(content, header, vertices, invalid, run)
                                           : read_binary(content, header, vertices, invalid, run);
}

}  // namespace cloud2csg
