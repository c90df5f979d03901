#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "io/clouds/cloud_assembly.hpp"
#include "io/clouds/formats.hpp"
#include "io/clouds/ply.hpp"

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

Eigen::Vector3d vector_of(const PlyRecords& records, const std::array<std::size_t, 3>& properties) {
  return {records.number(properties[0]), records.number(properties[1]), records.number(properties[2])};
}

/// For text, and for binary records whose length depends on lists.
PointCloud read_one_by_one(const FileContent& content, const PlyElement& element, const PointLayout& layout,
                           PlyRecords records, InvalidPoints invalid, const RunContext& run) {
  CloudAssembly assembly(content, element.count, std::min(element.count, content.bytes().size() / 4), invalid, run);
  for (std::size_t i = 0; i < element.count; ++i) {
    if (!records.next(element)) content.fail_truncated(records.where(), element.count, i);
    assembly.add(layout.map([&](const auto& properties) { return vector_of(records, properties); }), records.where());
  }
  return std::move(assembly).finish();
}

PointCloud read_equal_records(const FileContent& content, const PlyElement& element, const PointLayout& layout,
                              std::size_t offset, std::endian order, InvalidPoints invalid, const RunContext& run) {
  const std::size_t stride = element.stride();
  const std::size_t found = (content.bytes().size() - offset) / stride;
  if (found < element.count) {
    content.fail_truncated({FilePosition::Unit::byte, offset + found * stride}, element.count, found);
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

}  // namespace

PointCloud read_ply(const FileContent& content, InvalidPoints invalid, const RunContext& run) {
  const PlyHeader header = parse_ply_header(content);
  const VertexElement vertices = find_vertices(content, header);
  const PlyElement& element = header.elements[vertices.index];
  PlyRecords records(content, header);
  for (std::size_t before = 0; before < vertices.index; ++before) {
    if (records.skip(header.elements[before]) < header.elements[before].count) {
      content.fail_truncated(records.where(), element.count, 0);
    }
  }
  if (header.format == PlyFormat::ascii || element.has_lists()) {
    return read_one_by_one(content, element, vertices.layout, records, invalid, run);
  }
  const std::endian order = header.format == PlyFormat::binary_little_endian ? std::endian::little : std::endian::big;
  return read_equal_records(content, element, vertices.layout, records.offset(), order, invalid, run);
}

}  // namespace cloud2csg
