#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "io/clouds/ply.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

/// The index of a property in an element. @throws Error at the element's line when it is missing.
std::size_t find_property(const FileContent& content, const PlyElement& element, std::string_view name,
                          std::string_view other_name, bool is_list) {
  const auto found = std::ranges::find_if(element.properties, [&](const PlyProperty& property) {
    return (property.name == name || property.name == other_name) && property.list_count.has_value() == is_list;
  });
  if (found == element.properties.end()) {
    content.fail({FilePosition::Unit::line, element.header_line},
                 fmt::format("expected a {} \"{}\" in this element", is_list ? "list" : "property", name));
  }
  return static_cast<std::size_t>(found - element.properties.begin());
}

}  // namespace

TriangleMesh read_ply_mesh(const FileContent& content) {
  const PlyHeader header = parse_ply_header(content);
  PlyRecords records(content, header);
  MeshAssembly assembly(content);
  const auto step_through = [&](const PlyElement& element, const auto& add) {
    for (std::size_t i = 0; i < element.count; ++i) {
      if (!records.next(element)) content.fail_truncated(records.where(), element.count, i, "records");
      add();
    }
  };
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      std::array<std::size_t, 3> axes{};
      std::ranges::transform(std::array{"x", "y", "z"}, axes.begin(),
                             [&](const char* axis) { return find_property(content, element, axis, axis, false); });
      step_through(element, [&] {
        assembly.add_vertex(std::array{records.number(axes[0]), records.number(axes[1]), records.number(axes[2])},
                            records.where());
      });
    } else if (element.name == "face") {
      const std::size_t corners = find_property(content, element, "vertex_indices", "vertex_index", true);
      step_through(element, [&] { assembly.add_polygon(records.list(corners), records.where()); });
      break;  // later elements are not needed
    } else if (records.skip(element) < element.count) {
      content.fail_truncated(records.where(), element.count, 0, "records");
    }
  }
  return std::move(assembly).finish();
}

}  // namespace cloud2csg
