#include "fuzz/seeds.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <iterator>

#include "cloud2csg/export.hpp"
#include "cloud2csg/input.hpp"
#include "core/base/files.hpp"
#include "io/clouds/file_content.hpp"
#include "io/meshes/zip_archive.hpp"

namespace cloud2csg::fuzz {
namespace {

constexpr const char* k_model_in_3mf = "3D/3dmodel.model";

Model small_model() {
  return parse_model(R"({"format": "cloud2csg", "version": 1, "description": "of all kinds", "primitives": [
    {"id": "plate", "type": "box", "size": [4, 3, 1]},
    {"id": "bore", "type": "cylinder", "radius": 0.5, "height": 3, "pose": {"position": [0.5, 0.25, 0]}},
    {"id": "ball", "type": "sphere", "radius": 0.7, "pose": {"position": [-1, 0, 0.5]}},
    {"id": "tip", "type": "cone", "radius_bottom": 1, "radius_top": 0.25, "height": 1,
     "pose": {"position": [1, 1, 1], "quaternion": [0.8, 0.6, 0, 0]}},
    {"id": "ring", "type": "torus", "major_radius": 1, "minor_radius": 0.25}],
    "tree": {"op": "difference", "children": [
      {"op": "union", "children": [{"primitive": "plate"}, {"primitive": "ball"}, {"primitive": "tip"},
       {"op": "intersection", "children": [{"primitive": "ring"}, {"primitive": "plate"}]}]},
      {"primitive": "bore"}]}})",
                     "small.json");
}

TriangleMesh cube() {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) mesh.vertices.push_back(Eigen::Vector3d(i & 1U, i >> 1U & 1U, i >> 2U & 1U));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

template <typename Number>
void append_bytes(std::string& out, Number value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  out.append(bytes.data(), bytes.size());
}

std::string stl_text(const TriangleMesh& mesh) {
  std::string out = "solid cube\n";
  for (const auto& triangle : mesh.triangles) {
    out += "  facet normal 0 0 1\n    outer loop\n";
    for (const std::uint32_t corner : triangle) {
      const Eigen::Vector3d v = mesh.vertices[corner];
      fmt::format_to(std::back_inserter(out), "      vertex {} {} {}\n", v.x(), v.y(), v.z());
    }
    out += "    endloop\n  endfacet\n";
  }
  return out + "endsolid cube\n";
}

std::string ply_mesh(const TriangleMesh& mesh, bool is_text) {
  std::string out = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n",
      is_text ? "ascii" : "binary_little_endian", mesh.vertices.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d v = mesh.vertices[i];
    if (is_text) {
      fmt::format_to(std::back_inserter(out), "{} {} {}\n", v.x(), v.y(), v.z());
    } else {
      for (const double coordinate : v) append_bytes(out, static_cast<float>(coordinate));
    }
  }
  for (const auto& triangle : mesh.triangles) {
    if (is_text) {
      fmt::format_to(std::back_inserter(out), "3 {} {} {} 0\n", triangle[0], triangle[1], triangle[2]);
    } else {
      append_bytes(out, std::uint8_t{3});
      for (const std::uint32_t corner : triangle) append_bytes(out, corner);
      append_bytes(out, std::uint8_t{0});
    }
  }
  return out;
}

/// Of two lines, the second of numbers and with ends of lines of its own.
std::string pack_glb(const std::string& lines) {
  const std::size_t split = lines.find('\n');
  std::string json = lines.substr(0, split);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string numbers = split == std::string::npos ? std::string() : lines.substr(split + 1);
  std::string out = "glTF";
  for (const std::size_t word : {std::size_t{2}, 28 + json.size() + numbers.size(), json.size()}) {
    append_bytes(out, static_cast<std::uint32_t>(word));
  }
  out += "JSON" + json;
  append_bytes(out, static_cast<std::uint32_t>(numbers.size()));
  return out + std::string("BIN\0", 4) + numbers;
}

/// Two nodes with a mesh each, one within the other.
std::string glb_lines(const TriangleMesh& mesh) {
  std::string numbers;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (const double coordinate : mesh.vertices[i]) append_bytes(numbers, static_cast<float>(coordinate));
  }
  const std::size_t split = numbers.size();
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) append_bytes(numbers, static_cast<std::uint16_t>(corner));
  }
  return fmt::format(
             R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0,"children":[1]}},)"
             R"({{"mesh":0,"translation":[2,0,0],"rotation":[0,0,0,1],"scale":[1,1,-1]}}],)"
             R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":4}}]}}],)"
             R"("buffers":[{{"byteLength":{}}}],"bufferViews":[{{"buffer":0,"byteLength":{}}},)"
             R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"accessors":[{{"bufferView":0,"componentType":5126,)"
             R"("count":{},"type":"VEC3"}},{{"bufferView":1,"byteOffset":0,"componentType":5123,"count":{},)"
             R"("type":"SCALAR"}}]}})",
             numbers.size(), split, split, numbers.size() - split, mesh.vertices.size(), 3 * mesh.triangles.size()) +
         "\n" + numbers;
}

std::string pack_3mf(const std::string& model) {
  constexpr std::string_view k_relations =
      R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship )"
      R"(Target="/3D/3dmodel.model" Id="m" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>)"
      R"(</Relationships>)";
  return zip_archive(std::array{ZipEntry{"_rels/.rels", k_relations}, ZipEntry{k_model_in_3mf, model}});
}

/// Two objects, one of parts that are moved.
std::string model_of_parts(const std::string& model) {
  std::string text = model;
  const std::size_t end = text.find("</resources>");
  text.insert(end, R"(<object id="2" type="model"><components><component objectid="1"/>)"
                   R"(<component objectid="1" transform="1 0 0 0 -1 0 0 0 1 5 0 0"/></components></object>)");
  text.replace(text.find("<item objectid=\"1\"/>"), 20, R"(<item objectid="1"/><item objectid="2"/>)");
  return text;
}

}  // namespace

std::vector<Seed> make_seeds(const std::filesystem::path& folder) {
  const Model model = small_model();
  const TriangleMesh mesh = cube();
  std::vector<Seed> seeds;
  const auto add = [&](const char* ending, const auto& write) {
    const std::filesystem::path file = folder / (std::string("seed") + ending);
    write(file);
    seeds.push_back({.ending = ending, .bytes = read_text_file(file)});
    std::filesystem::remove(file);
  };
  for (const char* ending : {".stl", ".off", ".obj", ".3mf"}) {
    add(ending, [&](const std::filesystem::path& file) { write_mesh(file, mesh); });
  }
  PointCloud cloud = sample_mesh(mesh, {.mesh_points = 40}, {.threads = 1});
  for (const char* ending : {".ply", ".pcd", ".xyz", ".pts"}) {
    add(ending, [&](const std::filesystem::path& file) { write_point_cloud(file, cloud, {}); });
  }
  add(".json", [&](const std::filesystem::path& file) { write_model(file, model); });
  seeds.push_back({.ending = ".scad", .bytes = to_openscad(model)});
  seeds.push_back({.ending = ".csg", .bytes = to_openscad_csg(model)});
  seeds.push_back({.ending = ".stl", .bytes = stl_text(mesh)});
  seeds.push_back({.ending = ".ply", .bytes = ply_mesh(mesh, true)});
  seeds.push_back({.ending = ".ply", .bytes = ply_mesh(mesh, false)});
  seeds.push_back({.ending = ".glb", .bytes = pack_glb(glb_lines(mesh))});
  seeds.push_back({.ending = ".glb", .bytes = glb_lines(mesh), .pack = pack_glb});
  const std::filesystem::path archive = folder / "seed.3mf";
  write_mesh(archive, mesh);
  const std::string text = unzip_entry(FileContent(archive), k_model_in_3mf, std::size_t{1} << 20U);
  std::filesystem::remove(archive);
  seeds.push_back({.ending = ".3mf", .bytes = model_of_parts(text), .pack = pack_3mf});
  return seeds;
}

}  // namespace cloud2csg::fuzz
