#include "io/clouds/text_rows.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

/// The vertices of words such as `vertex/texture/normal`. A negative number counts backwards from the last vertex.
std::vector<double> obj_corners(const TextRows& rows, std::string_view text, double vertices) {
  std::vector<double> corners;
  for (const std::string& word : split_words(text)) {
    const std::optional<double> number = parse_number(std::string_view(word).substr(0, word.find('/')));
    if (!number) rows.fail_number(word);
    corners.push_back(*number < 0.0 && -*number <= vertices ? *number + vertices + 1.0 : *number);
  }
  return corners;
}

}  // namespace

TriangleMesh read_obj(const FileContent& content) {
  TextRows rows(content);
  MeshAssembly assembly(content);
  while (const std::optional<std::string_view> line = rows.next_line()) {
    const auto [keyword, rest] = first_word(*line);
    if (keyword == "v") {
      assembly.add_vertex(rows.numbers_in(rest), rows.where());
    } else if (keyword == "f") {
      const auto vertices = static_cast<double>(assembly.vertex_count());
      assembly.add_polygon(obj_corners(rows, rest, vertices), rows.where(), 1);
    }
  }
  return std::move(assembly).finish();
}

}  // namespace cloud2csg
