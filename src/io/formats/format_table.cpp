#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "io/formats/formats.hpp"

namespace cloud2csg {
namespace {

using Start = FileStart;
using Rows = std::vector<std::vector<std::string>>;

bool begins(const Start& start, std::string_view mark) {
  return start.text.starts_with(mark);
}
bool has(const Start& start, std::string_view mark) {
  return start.text.find(mark) != std::string::npos;
}

/// People write such files by hand, too, so only the mark tells.
bool is_marked(const Start& start) {
  return has(start, k_program_mark);
}

/// Compares without white space, which does not matter in JSON.
bool has_in_json(const Start& start, std::string_view mark) {
  std::string text = start.text;
  std::erase_if(text, [](char c) { return std::string_view(" \t\r\n").find(c) != std::string_view::npos; });
  return text.starts_with('{') && text.find(mark) != std::string::npos;
}

/// The words of all lines except blank lines and comments. Drops the last line if the file continues after it.
Rows rows_of(const Start& start) {
  std::string text = start.text;
  if (text.size() < start.file_size) text.resize(text.rfind('\n') + 1);
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ';'; }, ' ');
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<std::string> row(std::istream_iterator<std::string>(words), {});
    if (!row.empty() && !row[0].starts_with('#') && !row[0].starts_with("//")) rows.push_back(std::move(row));
  }
  return rows;
}

bool is_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  return std::from_chars(word.data(), word.data() + word.size(), value).ptr == word.data() + word.size();
}

bool is_rows_of_numbers(const Start& start) {
  const Rows rows = rows_of(start);
  return !rows.empty() &&
         std::ranges::all_of(rows, [](const auto& row) { return std::ranges::all_of(row, is_number); });
}

bool is_pcd(const Start& start) {
  return std::ranges::any_of(rows_of(start), [](const auto& row) { return row[0] == "FIELDS"; });
}

/// Text with facets, or a size that matches the triangle count of the binary form.
bool is_stl(const Start& start) {
  constexpr std::size_t k_header = 80;
  constexpr std::uintmax_t k_triangle = 50;
  if (begins(start, "solid") && (has(start, "facet") || has(start, "endsolid"))) return true;
  if (start.text.size() < k_header + 4) return false;
  std::uintmax_t count = 0;
  for (std::size_t i = 4; i-- > 0;) count = 256 * count + static_cast<unsigned char>(start.text[k_header + i]);
  return start.file_size == k_header + 4 + k_triangle * count;
}

/// The first word is OFF, possibly after letters for colours and normals.
bool is_off(const Start& start) {
  const Rows rows = rows_of(start);
  return !rows.empty() && rows[0][0].ends_with("OFF") && rows[0][0].size() < 8;
}

/// Each line begins with a keyword of the format, and at least one is a vertex.
bool is_obj(const Start& start) {
  constexpr std::array<std::string_view, 13> k_words{"v", "vt", "vn",     "vp",     "f", "l",     "p",
                                                     "o", "g",  "usemtl", "mtllib", "s", "cstype"};
  const Rows rows = rows_of(start);
  return std::ranges::any_of(rows, [](const auto& row) { return row[0] == "v" && row.size() > 3; }) &&
         std::ranges::all_of(rows,
                             [&](const auto& row) { return std::ranges::find(k_words, row[0]) != k_words.end(); });
}

using Id = FileFormat::Id;
using Kind = FileKind;
using Trait = FileFormat::Trait;

constexpr std::array<FileFormat, 21> k_formats{{
    {Id::ply, Kind::cloud, "PLY file", {".ply"}, [](const Start& s) { return begins(s, "ply") && has(s, "element"); }},
    {Id::pcd, Kind::cloud, "PCD file", {".pcd"}, is_pcd},
    {Id::xyz, Kind::cloud, "file of rows of numbers", {".xyz", ".txt"}, is_rows_of_numbers, Trait::plain},
    {Id::xyzn, Kind::cloud, "file of rows of numbers", {".xyzn"}, is_rows_of_numbers, Trait::plain},
    {Id::pts, Kind::cloud, "file of rows of numbers", {".pts"}, is_rows_of_numbers, Trait::plain},
    {Id::json,
     Kind::model,
     "model of cloud2csg",
     {".json"},
     [](const Start& s) { return has_in_json(s, R"("format":"cloud2csg")"); }},
    {Id::scad, Kind::model, "OpenSCAD script of cloud2csg", {".scad"}, is_marked, Trait::plain},
    {Id::csg, Kind::model, "OpenSCAD script of cloud2csg", {".csg"}, is_marked, Trait::plain},
    {Id::freecad, Kind::script, "FreeCAD macro of cloud2csg", {".FCMacro"}, is_marked, Trait::plain},
    {Id::cadquery, Kind::script, "Python script of cloud2csg", {".py"}, is_marked, Trait::plain},
    {Id::step, Kind::solid, "STEP file", {".step", ".stp"}, [](const Start& s) { return begins(s, "ISO-10303-21"); }},
    {Id::brep, Kind::solid, "BREP file", {".brep"}, [](const Start& s) { return has(s, "CASCADE Topology"); }},
    {Id::stl, Kind::mesh, "STL file", {".stl"}, is_stl},
    {Id::off, Kind::mesh, "OFF file", {".off"}, is_off},
    {Id::obj, Kind::mesh, "OBJ file", {".obj"}, is_obj},
    {Id::threemf,
     Kind::mesh,
     "3MF archive",
     {".3mf"},
     [](const Start& s) { return begins(s, "PK\x03\x04") && has(s, "3D/"); }},
    {Id::glb, Kind::mesh, "GLB file", {".glb"}, [](const Start& s) { return begins(s, "glTF"); }, Trait::read_only},
    {Id::dot, Kind::graph, "graph of cloud2csg", {".dot"}, is_marked, Trait::plain},
    {Id::html,
     Kind::page,
     "page of cloud2csg",
     {".html"},
     [](const Start& s) { return has(s, R"(name="generator" content="cloud2csg)"); }},
    {Id::png, Kind::picture, "PNG picture", {".png"}, [](const Start& s) { return begins(s, "\x89PNG"); }},
    {Id::statistics,
     Kind::statistics,
     "file of statistics of cloud2csg",
     {".json"},
     [](const Start& s) { return has_in_json(s, R"("unassigned_points":)"); }},
}};

}  // namespace

std::span<const FileFormat> file_formats() {
  return k_formats;
}

}  // namespace cloud2csg
