#include "core/base/overwriting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/file_ending.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_looked_at = 4096;

/// Of a file that is there.
struct Beginning {
  std::string text;
  std::uintmax_t file_size = 0;
};

struct Kind {
  std::string_view ending;
  std::string_view name;
  bool (*is_it)(const Beginning& beginning, std::string_view mark);
  std::string_view mark = k_program_mark;
  Content content = Content::by_ending;
};

bool starts(const Beginning& beginning, std::string_view mark) {
  return beginning.text.starts_with(mark);
}

bool has(const Beginning& beginning, std::string_view mark) {
  return beginning.text.find(mark) != std::string::npos;
}

/// JSON is the same with spaces or without.
bool has_in_json(const Beginning& beginning, std::string_view mark) {
  std::string text = beginning.text;
  std::erase_if(text, [](unsigned char letter) { return std::isspace(letter) != 0; });
  return text.starts_with('{') && text.find(mark) != std::string::npos;
}

constexpr std::string_view k_separators = " \t\r\f\v,;";

/// Words of the lines that hold something and are no comments; without the last when the file goes on behind it.
std::vector<std::vector<std::string_view>> rows_of(const Beginning& beginning) {
  std::vector<std::vector<std::string_view>> rows;
  std::string_view text = beginning.text;
  if (text.size() < beginning.file_size) text = text.substr(0, text.rfind('\n') + 1);
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    std::vector<std::string_view> row;
    for (std::size_t at = 0; (at = line.find_first_not_of(k_separators, at)) != std::string_view::npos;) {
      row.push_back(line.substr(at, std::min(line.find_first_of(k_separators, at), line.size()) - at));
      at += row.back().size();
    }
    if (!row.empty() && !row[0].starts_with('#') && !row[0].starts_with("//")) rows.push_back(std::move(row));
  }
  return rows;
}

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  return std::from_chars(word.data(), word.data() + word.size(), value).ptr == word.data() + word.size();
}

bool is_rows_of_numbers(const Beginning& beginning, std::string_view /*mark*/) {
  const auto rows = rows_of(beginning);
  return !rows.empty() &&
         std::ranges::all_of(rows, [](const auto& row) { return std::ranges::all_of(row, is_number); });
}

/// Text with triangles, or as many bytes as the binary form counts triangles.
bool is_stl(const Beginning& beginning, std::string_view /*mark*/) {
  constexpr std::size_t k_header = 80;
  constexpr std::uintmax_t k_triangle = 50;
  const std::string& text = beginning.text;
  if (text.starts_with("solid") && (has(beginning, "facet") || has(beginning, "endsolid"))) return true;
  if (text.size() < k_header + 4) return false;
  std::uintmax_t count = 0;
  for (std::size_t i = 4; i-- > 0;) count = 256 * count + static_cast<unsigned char>(text[k_header + i]);
  return beginning.file_size == k_header + 4 + k_triangle * count;
}

/// Each line begins with a word of the format, one of them with that of a vertex.
bool is_obj(const Beginning& beginning, std::string_view /*mark*/) {
  constexpr std::array<std::string_view, 13> k_words{"v", "vt", "vn",     "vp",     "f", "l",     "p",
                                                     "o", "g",  "usemtl", "mtllib", "s", "cstype"};
  const auto rows = rows_of(beginning);
  const bool has_vertex = std::ranges::any_of(rows, [](const auto& row) { return row[0] == "v" && row.size() > 3; });
  return has_vertex && std::ranges::all_of(
                           rows, [&](const auto& row) { return std::ranges::find(k_words, row[0]) != k_words.end(); });
}

/// The first word is OFF, or with letters before it that tell of colours and normals.
bool is_off(const Beginning& beginning, std::string_view mark) {
  const auto rows = rows_of(beginning);
  return !rows.empty() && rows[0][0].ends_with(mark) && rows[0][0].size() < mark.size() + 5;
}

/// One of its lines begins with this word.
bool has_row(const Beginning& beginning, std::string_view mark) {
  return std::ranges::any_of(rows_of(beginning), [&](const auto& row) { return row[0] == mark; });
}

constexpr std::array<Kind, 22> k_kinds{
    {{".html", "page of cloud2csg", has, R"(name="generator" content="cloud2csg)"},
     {".scad", "OpenSCAD script of cloud2csg", has},
     {".csg", "OpenSCAD script of cloud2csg", has},
     {".py", "Python script of cloud2csg", has},
     {".fcmacro", "FreeCAD macro of cloud2csg", has},
     {".dot", "graph of cloud2csg", has},
     {".json", "model of cloud2csg", has_in_json, R"("format":"cloud2csg")"},
     {".json", "file of statistics of cloud2csg", has_in_json, R"("unassigned_points":)", Content::statistics},
     {".png", "PNG picture", starts, "\x89PNG"},
     {".ply", "PLY file", has_row, "element"},
     {".pcd", "PCD file", has_row, "FIELDS"},
     {".xyz", "file of rows of numbers", is_rows_of_numbers},
     {".xyzn", "file of rows of numbers", is_rows_of_numbers},
     {".txt", "file of rows of numbers", is_rows_of_numbers},
     {".pts", "file of rows of numbers", is_rows_of_numbers},
     {".stl", "STL file", is_stl},
     {".obj", "OBJ file", is_obj},
     {".off", "OFF file", is_off, "OFF"},
     {".3mf", "3MF archive", starts, "PK\x03\x04"},
     {".step", "STEP file", starts, "ISO-10303-21"},
     {".stp", "STEP file", starts, "ISO-10303-21"},
     {".brep", "BREP file", has, "CASCADE Topology"}}};

Beginning beginning_of(const std::filesystem::path& file) {
  std::error_code ignored;
  Beginning beginning{.text = std::string(k_looked_at, '\0'), .file_size = std::filesystem::file_size(file, ignored)};
  std::ifstream older(file, std::ios::binary);
  older.read(beginning.text.data(), static_cast<std::streamsize>(k_looked_at));
  beginning.text.resize(static_cast<std::size_t>(older.gcount()));
  return beginning;
}

}  // namespace

void check_overwriting(const std::filesystem::path& file, Content content) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return;
  const Beginning beginning = beginning_of(file);
  const std::string ending = lower_ending(file);
  const auto kind =
      std::ranges::find_if(k_kinds, [&](const Kind& one) { return one.ending == ending && one.content == content; });
  const bool is_unknown = kind == k_kinds.end();  // refused where it is written
  if (is_unknown || beginning.file_size == 0 || kind->is_it(beginning, kind->mark)) return;
  throw Error({.file = file.string(),
               .where = {},
               .expected = fmt::format("is there already and is no {}", kind->name),
               .remedy = "remove it, or choose another name"});
}

}  // namespace cloud2csg
