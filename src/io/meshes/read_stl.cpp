#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>

#include "core/base/text.hpp"
#include "io/clouds/scalar_type.hpp"
#include "io/clouds/text_rows.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

// Head: 80 bytes and the number of triangles. Triangle: normal, three corners and two bytes.
constexpr std::size_t k_stl_head = 84;
constexpr std::size_t k_stl_triangle = 50;
constexpr std::size_t k_stl_vector = 12;

void add_stl_triangle(MeshAssembly& assembly, FilePosition where) {
  const auto end = static_cast<double>(assembly.vertex_count());
  assembly.add_polygon(std::array{end - 3.0, end - 2.0, end - 1.0}, where);
}

TriangleMesh read_stl_text(const FileContent& content) {
  TextRows rows(content);
  MeshAssembly assembly(content);
  std::size_t corners = 0;
  while (const std::optional<std::string_view> line = rows.next_line()) {
    const auto [word, rest] = first_word(*line);
    const std::string keyword = lower_case(std::string(word));
    if (keyword == "vertex") {
      assembly.add_vertex(rows.numbers_in(rest), rows.where());
      ++corners;
    } else if (keyword == "endfacet") {
      if (corners != 3) content.fail(rows.where(), fmt::format("expected a facet of 3 vertices, found {}", corners));
      add_stl_triangle(assembly, rows.where());
      corners = 0;
    }
  }
  if (corners > 0) {
    content.fail(rows.where(), "expected \"endfacet\", found the end of the file", k_copy_again);
  }
  return std::move(assembly).finish();
}

TriangleMesh read_stl_binary(const FileContent& content, std::size_t count) {
  MeshAssembly assembly(content);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = k_stl_head + i * k_stl_triangle;
    const FilePosition where{FilePosition::Unit::byte, begin};
    for (std::size_t corner = 1; corner <= 3; ++corner) {
      const char* const base = content.bytes().data() + begin + corner * k_stl_vector;
      std::array<double, 3> numbers{};
      decode_column({base, sizeof(float), ScalarType::float32, std::endian::little}, numbers);
      assembly.add_vertex(numbers, where);
    }
    add_stl_triangle(assembly, where);
  }
  return std::move(assembly).finish();
}

}  // namespace

TriangleMesh read_stl(const FileContent& content) {
  const std::string_view bytes = content.bytes();
  const bool has_head = bytes.size() >= k_stl_head;
  const std::size_t announced =
      has_head ? load<std::uint32_t>(bytes.data() + k_stl_head - sizeof(std::uint32_t), std::endian::little) : 0;
  const std::size_t found = has_head ? (bytes.size() - k_stl_head) / k_stl_triangle : 0;
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  const bool begins_like_text =
      begin != std::string_view::npos && lower_case(std::string(bytes.substr(begin, 5))) == "solid";
  // Some binary files also begin with "solid".
  const bool is_exact = has_head && bytes.size() == k_stl_head + announced * k_stl_triangle;
  if (begins_like_text && !is_exact) return read_stl_text(content);
  if (!has_head) content.fail("expected a .stl file, of text or binary, found neither", "is it a .stl file?");
  if (found < announced) {
    content.fail_truncated({FilePosition::Unit::byte, bytes.size()}, announced, found, "triangles");
  }
  return read_stl_binary(content, announced);
}

}  // namespace cloud2csg
