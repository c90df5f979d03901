#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/text.hpp"
#include "io/clouds/text_rows.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

/// Prefixes announce normals, colours or texture coordinates after the coordinates of a vertex.
constexpr std::array<std::string_view, 8> k_off_words{"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                      "STOFF", "STCOFF", "STNOFF", "STCNOFF"};

struct OffCounts {
  std::size_t vertices;
  std::size_t faces;
};

/// The counts are in the line of the first word or in the next one.
OffCounts read_off_header(const FileContent& content, TextRows& rows) {
  const auto [word, rest] = first_word(rows.next_line().value_or(""));
  if (std::ranges::find(k_off_words, word) == k_off_words.end()) {
    content.fail(rows.where(), fmt::format(R"(expected "OFF" first, found "{}")", visible_text(word, k_longest_quote)),
                 "is it a .off file in text form?");
  }
  const std::vector<std::string> words = split_words(rest.empty() ? rows.next_line().value_or("") : rest);
  const std::optional<std::size_t> vertices = words.size() < 2 ? std::nullopt : parse_count(words[0]);
  const std::optional<std::size_t> faces = words.size() < 2 ? std::nullopt : parse_count(words[1]);
  if (!vertices || !faces) content.fail(rows.where(), "expected the numbers of vertices, faces and edges");
  return {.vertices = *vertices, .faces = *faces};
}

}  // namespace

TriangleMesh read_off(const FileContent& content) {
  TextRows rows(content);
  const OffCounts counts = read_off_header(content, rows);
  MeshAssembly assembly(content);
  for (std::size_t i = 0; i < counts.vertices; ++i) {
    const std::optional<std::span<const double>> row = rows.next_row();
    if (!row) content.fail_truncated(rows.where(), counts.vertices, i, "vertices");
    assembly.add_vertex(*row, rows.where());
  }
  for (std::size_t i = 0; i < counts.faces; ++i) {
    const std::optional<std::span<const double>> row = rows.next_row();
    if (!row) content.fail_truncated(rows.where(), counts.faces, i, "faces");
    const std::optional<std::size_t> corners = whole_number(row->front(), row->size() - 1);
    if (!corners) {
      content.fail(rows.where(), fmt::format("expected the number of corners and as many vertices, found {} and {}",
                                             row->front(), row->size() - 1));
    }
    assembly.add_polygon(row->subspan(1, *corners), rows.where());
  }
  return std::move(assembly).finish();
}

}  // namespace cloud2csg
