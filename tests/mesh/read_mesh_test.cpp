#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "io/meshes/zip_archive.hpp"
#include "mesh/read_bytes.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using shapes::area_vector;
using shapes::read_bytes;

void expect_refused(const std::string& name, const std::string& bytes, const std::string& where,
                    const std::string& expected) {
  try {
    (void)read_bytes(name, bytes);
    ADD_FAILURE() << "accepted " << name << ", which lacks " << expected;
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, where) << error.what();
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
}

/// Volume of a closed mesh that is oriented outward, 0 for others.
double closed_volume(const TriangleMesh& mesh) {
  return is_watertight(mesh) ? volume_of(mesh) : 0.0;
}

template <typename Number>
std::string bytes_of(Number value, std::endian order = std::endian::little) {
  auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  if (order != std::endian::native) std::ranges::reverse(bytes);
  return {bytes.data(), bytes.size()};
}

const std::string k_tetrahedron_text = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
constexpr std::array<std::array<std::uint32_t, 3>, 4> k_tetrahedron{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
constexpr std::array<float, 12> k_tetrahedron_corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

TEST(ReadOff, KeepsDoublePrecisionAndTheOrderOfTheFile) {
  const TriangleMesh mesh =
      read_bytes("a.off", "OFF\n4 1 0\n0.1 0 1e-300\n9 9 9\n1 0 0.30000000000000004\n0 1 0\n3 0 2 3\n");
  EXPECT_EQ(mesh.vertices[0], Vector3d(0.1, 0, 1e-300));
  EXPECT_EQ(mesh.vertices[2], Vector3d(1, 0, 0.30000000000000004));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 2, 3}}));
}

TEST(ReadOff, KnowsItsKinds) {
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3 1 0 0\n3 2 0 3 # red\n";
  EXPECT_NEAR(closed_volume(read_bytes("a.off", "OFF 4 4 6\n" + k_tetrahedron_text + faces)), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(closed_volume(read_bytes("a.off", "# c\n\nOFF # d\n4 4 0\n# e\n" + k_tetrahedron_text + "\n" + faces)),
              1.0 / 6.0, 1e-15);
  for (const char* word : {"COFF", "NOFF", "CNOFF"}) {
    const TriangleMesh mesh = read_bytes(
        "a.off", word + std::string("\n4 4 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n") + faces);
    EXPECT_NEAR(closed_volume(mesh), 1.0 / 6.0, 1e-15) << word;
  }
}

TEST(ReadOff, RefusesNamingTheLine) {
  expect_refused("a.off", "", "line 0", "expected \"OFF\"");
  expect_refused("a.off", "OFF BINARY\n", "line 1", "numbers of vertices, faces");
  expect_refused("a.off", "4OFF\n1 1 0\n", "line 1", "expected \"OFF\" first, found \"4OFF\"");
  expect_refused("a.off", "OFF\n-1 1 0\n", "line 2", "numbers of vertices, faces");
  expect_refused("a.off", "OFF\n99999999999999999 1 0\n0 0 0\n", "line 3", "announces 99999999999999999 vertices");
  expect_refused("a.off", "OFF\n4 9 0\n" + k_tetrahedron_text + "3 0 1 2\n", "line 7",
                 "announces 9 faces but ends after 1");
  expect_refused("a.off", "OFF\n4 1 0\n" + k_tetrahedron_text + "3 0 1 4\n", "line 7", "one of the 4 vertices so far");
  expect_refused("a.off", "OFF\n4 1 0\n" + k_tetrahedron_text + "3 0 1 -1\n", "line 7", "one of the 4 vertices so far");
  expect_refused("a.off", "OFF\n4 1 0\n" + k_tetrahedron_text + "3 0 1 0.5\n", "line 7", "found 0.5");
  expect_refused("a.off", "OFF\n4 1 0\n" + k_tetrahedron_text + "4 0 1 2\n", "line 7", "number of corners");
  expect_refused("a.off", "OFF\n4 1 0\n" + k_tetrahedron_text + "4294967296 0 1 2\n", "line 7", "number of corners");
  expect_refused("a.off", "OFF\n2 1 0\n0 0 0\n0 1e39 0\n", "line 4", "finite coordinates");
  expect_refused("a.off", "OFF\n2 1 0\n0 0 0\n0 nan 0\n", "line 4", "finite coordinates");
}

TEST(ReadObj, CountsFromBothEnds) {
  const std::string text =
      "mtllib a.mtl\no part\nv 0 0 0\nv 1 0 0 1 0.5 0.5 0.5\nv 0 1 0 # c\nv 0 0 1\nvn 0 0 1\nvt 0 0\nusemtl m\n"
      "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\ns off\nf -3 -2 -1\nf 3/1 1/1 4/1\nl 1 2\np 1\n";
  EXPECT_NEAR(closed_volume(read_bytes("a.obj", text)), 1.0 / 6.0, 1e-15);
}

TEST(ReadObj, RefusesNamingTheLine) {
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4", "counted from 1, found 4");
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4", "counted from 1, found 0");
  expect_refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 1 2\n", "line 4", "found -4");
  expect_refused("a.obj", "v 0 0\n", "line 1", "x, y, z, found 2 numbers");
  expect_refused("a.obj", "v 0 0 0\nf 1 x 1\n", "line 2", "expected a number, found \"x\"");
}

TEST(ReadStl, TextAndBinaryWithTheSameFirstWord) {
  std::string text = "  Solid name # 1\n";
  std::string binary = "solid" + std::string(75, ' ') + bytes_of(std::uint32_t{4});
  for (const auto& triangle : k_tetrahedron) {
    text += "FACET NORMAL 0 0 0\r\n outer loop\n";
    binary += std::string(12, '\0');
    for (const std::uint32_t corner : triangle) {
      text += fmt::format("  vertex {} {} {}\n", k_tetrahedron_corners[3 * corner],
                          k_tetrahedron_corners[3 * corner + 1], k_tetrahedron_corners[3 * corner + 2]);
      for (std::size_t axis = 0; axis < 3; ++axis) binary += bytes_of(k_tetrahedron_corners[3 * corner + axis]);
    }
    text += " endloop\nendfacet\n";
    binary += std::string(2, '\0');
  }
  EXPECT_NEAR(closed_volume(read_bytes("a.stl", text + "endsolid name\n")), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(closed_volume(read_bytes("a.stl", binary)), 1.0 / 6.0, 1e-15);
  binary[0] = 'b';
  EXPECT_NEAR(closed_volume(read_bytes("a.stl", binary + "more")), 1.0 / 6.0, 1e-15);
  expect_refused("a.stl", binary.substr(0, 200), "byte 200", "announces 4 triangles but ends after 2");
  expect_refused("a.stl", text.substr(0, text.size() - 9), "line 28", "endfacet");
}

TEST(ReadStl, Refuses) {
  expect_refused("a.stl", "", "", "neither");
  expect_refused("a.stl", "solid a\nendsolid a\n", "", "expected triangles, found none");
  expect_refused("a.stl", "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n", "line 5", "3 vertices, found 2");
  expect_refused("a.stl", std::string(80, ' ') + bytes_of(0xFFFF'FFFFU), "byte 84", "announces 4294967295 triangles");
}

TEST(ReadPlyMesh, BinaryOfBothOrdersWithOtherElementsAndProperties) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string file = fmt::format(
        "ply\nformat binary_{}_endian 1.0\nelement nothing 18446744073709551615\nelement camera 2\nproperty short a\n"
        "element vertex 4\nproperty list uchar short more\nproperty double x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar float texcoord\nproperty list ushort uint vertex_index\nproperty uchar f\n"
        "end_header\n",
        order == std::endian::little ? "little" : "big");
    file += std::string(4, 'x');
    for (std::size_t i = 0; i < 4; ++i) {
      file += bytes_of(static_cast<std::uint8_t>(i % 2)) + std::string(2 * (i % 2), 'y');
      file += bytes_of(static_cast<double>(k_tetrahedron_corners[3 * i]), order);
      file += bytes_of(k_tetrahedron_corners[3 * i + 1], order) + bytes_of(k_tetrahedron_corners[3 * i + 2], order);
    }
    for (const auto& triangle : k_tetrahedron) {
      file += bytes_of(std::uint8_t{1}) + std::string(4, '\0') + bytes_of(std::uint16_t{3}, order);
      for (const std::uint32_t corner : triangle) file += bytes_of(corner, order);
      file += "f";
    }
    EXPECT_NEAR(closed_volume(read_bytes("a.ply", file)), 1.0 / 6.0, 1e-15);
    expect_refused("a.ply", file.substr(0, file.size() - 1), fmt::format("byte {}", file.size() - 20), "ends after 3");
  }
}

TEST(ReadPlyMesh, RefusesNamingTheLine) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string points = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  expect_refused("a.ply", head + face + points + "3 0 1 3\n", "line 13", "one of the 3 vertices so far");
  expect_refused("a.ply", head + face + points + "3 0 1 -1\n", "line 13", "one of the 3 vertices so far");
  expect_refused("a.ply", head + face + points + "3 0 1\n", "line 13", "1 properties");
  expect_refused("a.ply", head + face + points + "-1\n", "line 13", "properties");
  expect_refused("a.ply", head + face + points, "line 12", "announces 1 records but ends after 0");
  expect_refused("a.ply", head + "element face 1\nproperty int vertex_indices\n" + points + "3\n", "line 7",
                 "expected a list \"vertex_indices\"");
}

constexpr const char* k_3mf_triangles =
    R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>)"
    R"(<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>)"
    R"(<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh>)";

std::string threemf_of(const std::string& model) {
  constexpr std::string_view k_relations =
      R"(<Relationships><Relationship Target="/a/b.model" Id="m" )"
      R"(Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";
  return zip_archive(std::array{ZipEntry{"_rels/.rels", k_relations}, ZipEntry{"a/b.model", model}});
}

std::string threemf_of(const std::string& objects, const std::string& build, const std::string& unit = "millimeter") {
  return threemf_of(
      fmt::format(R"(<model unit="{}"><resources>{}</resources><build>{}</build></model>)", unit, objects, build));
}

TEST(Read3mf, PlacesTheObjectsThatAreBuiltInMillimetres) {
  const std::string objects = fmt::format(
      R"(<object id="1">{}</object><object id="7"><components><component objectid="1"/><component objectid="1" )"
      R"(transform="-1 0 0 0 2 0 0 0 3 9 0 0"/></components></object>)",
      k_3mf_triangles);
  const TriangleMesh one = read_bytes("a.3mf", threemf_of(objects, R"(<item objectid="1"/>)", "inch"));
  EXPECT_NEAR(closed_volume(one), 25.4 * 25.4 * 25.4 / 6.0, 1e-9);
  const TriangleMesh both =
      read_bytes("a.3mf", threemf_of(objects, R"(<item objectid="7" transform="1 0 0 0 1 0 0 0 1 0 0 100"/>)"));
  EXPECT_NEAR(closed_volume(both), 7.0 / 6.0, 1e-12) << "the mirrored one is not inside out";
  EXPECT_TRUE(bounds_of(both.vertices).isApprox(AlignedBox(Vector3d(0, 0, 100), Vector3d(9, 2, 103))));
}

TEST(Read3mf, Refuses) {
  const std::string object = fmt::format(R"(<object id="1">{}</object>)", k_3mf_triangles);
  expect_refused("a.3mf", "PK", "", "expected a zip archive");
  expect_refused("a.3mf", zip_archive(std::array{ZipEntry{"b", "c"}}), "", "expected _rels/.rels in the archive");
  expect_refused("a.3mf", threemf_of("<model>"), "", "found an error at its byte");
  expect_refused("a.3mf", threemf_of(object, ""), "", "expected triangles, found none");
  expect_refused("a.3mf", threemf_of(object, R"(<item objectid="2"/>)"), "", "the id of an object");
  expect_refused("a.3mf", threemf_of(object + object, ""), "", "a unique id");
  expect_refused("a.3mf", threemf_of(object, R"(<item objectid="1" transform="1 0 0"/>)"), "", "12 numbers");
  expect_refused("a.3mf", threemf_of(object, R"(<item objectid="1"/>)", "mile"), "", "found \"mile\"");
  expect_refused("a.3mf",
                 threemf_of(R"(<object id="1"><components><component objectid="1"/></components></object>)",
                            R"(<item objectid="1"/>)"),
                 "", "an object that does not contain itself");
  std::string wrong = object;
  wrong.replace(wrong.find("v3=\"1\""), 6, "v3=\"4\"");
  expect_refused("a.3mf", threemf_of(wrong, R"(<item objectid="1"/>)"), "triangle 0", "one of the 4 vertices so far");
  wrong.replace(wrong.find("x=\"1\""), 5, "x=\"a\"");
  expect_refused("a.3mf", threemf_of(wrong, R"(<item objectid="1"/>)"), "",
                 "expected a number as x of vertex, found \"a\"");
}

/// Few bytes that would need all memory or time.
TEST(Read3mf, RefusesBombs) {
  expect_refused("a.3mf", threemf_of(std::string(std::size_t{80} << 20U, ' ')), "", "too large when unpacked");
  std::string doubled = fmt::format(R"(<object id="0">{}</object>)", k_3mf_triangles);
  for (int i = 1; i < 60; ++i) {
    doubled += fmt::format(
        R"(<object id="{}"><components><component objectid="{}"/><component objectid="{}"/></components></object>)", i,
        i - 1, i - 1);
  }
  expect_refused("a.3mf", threemf_of(doubled, R"(<item objectid="59"/>)"), "", "repeated too often");
  expect_refused("a.3mf", threemf_of(std::string(1'000'000, 'x').insert(0, "<").append(">")), "", "error at its byte");
}

/// What a test changes in a .glb file of one tetrahedron, or of none.
struct Glb {
  std::string nodes = R"([{"mesh":0}])";
  std::string mode = "4";
  std::string indices = R"({"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"})";
  std::string positions = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
  std::string view = R"({"buffer":0,"byteLength":48})";
  std::string buffer = R"({"byteLength":60})";
  std::string numbers = {};

  [[nodiscard]] std::string file() const {
    std::string data = numbers;
    if (data.empty()) {
      for (const float corner : k_tetrahedron_corners) data += bytes_of(corner);
      for (const auto& triangle : k_tetrahedron) {
        for (const std::uint32_t corner : triangle) data += static_cast<char>(corner);
      }
    }
    std::string json = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":{},"meshes":[{{"primitives":[{{)"
        R"("attributes":{{"POSITION":0}},"indices":1,"mode":{}}}]}}],"buffers":[{}],"bufferViews":[{},)"
        R"({{"buffer":0,"byteOffset":48,"byteLength":{}}}],"accessors":[{},{}]}})",
        nodes, mode, buffer, view, data.size() - 48, positions, indices);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) { return bytes_of(static_cast<std::uint32_t>(value)); };
    return "glTF" + word(2) + word(28 + json.size() + data.size()) + word(json.size()) + "JSON" + json +
           word(data.size()) + std::string("BIN\0", 4) + data;
  }
};

TEST(ReadGlb, PlacesTheMeshesOfNodes) {
  EXPECT_NEAR(closed_volume(read_bytes("a.glb", Glb{}.file())), 1.0 / 6.0, 1e-15);
  const Glb nested{.nodes = R"([{"children":[1,2],"translation":[0,0,10],"scale":[2,2,2]},)"
                            R"({"mesh":0,"rotation":[0,0,0.70710678118654752,0.70710678118654752]},)"
                            R"({"mesh":0,"matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, -5,0,0,1]}])"};
  const TriangleMesh mesh = read_bytes("a.glb", nested.file());
  EXPECT_NEAR(closed_volume(mesh), 16.0 / 6.0, 1e-12) << "the mirrored one is not inside out";
  EXPECT_TRUE(bounds_of(mesh.vertices).isApprox(AlignedBox(Vector3d(-12, 0, 10), Vector3d(0, 2, 12)), 1e-12));
}

TEST(ReadGlb, KnowsStripsFansAndStrides) {
  // A tetrahedron as a strip: corners 0 2 1 3 0 2.
  std::string strip;
  for (const float corner : k_tetrahedron_corners) strip += bytes_of(corner);
  for (const int corner : {0, 2, 1, 3, 0, 2}) strip += bytes_of(static_cast<std::uint16_t>(corner));
  const Glb glb{
      .mode = "5", .indices = R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})", .numbers = strip};
  EXPECT_NEAR(closed_volume(read_bytes("a.glb", glb.file())), 1.0 / 6.0, 1e-15);
  std::string fan;
  for (const float corner : {0.F, 0.F, 0.F, 7.F, 1.F, 0.F, 0.F, 7.F, 1.F, 1.F, 0.F, 7.F}) fan += bytes_of(corner);
  fan +=
      bytes_of(std::uint32_t{0}) + bytes_of(std::uint32_t{1}) + bytes_of(std::uint32_t{2}) + bytes_of(std::uint32_t{1});
  const Glb other{.mode = "6",
                  .indices = R"({"bufferView":1,"componentType":5125,"count":3,"type":"SCALAR"})",
                  .positions = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
                  .view = R"({"buffer":0,"byteLength":48,"byteStride":16})",
                  .numbers = fan};
  EXPECT_EQ(area_vector(read_bytes("a.glb", other.file())), Vector3d(0, 0, 0.5));
}

TEST(ReadGlb, Refuses) {
  const auto refused = [](const Glb& glb, const std::string& expected, const std::string& where = {}) {
    expect_refused("a.glb", glb.file(), where, expected);
  };
  const std::string good = Glb{}.file();
  expect_refused("a.glb", "glTF", "", "expected binary glTF 2.0");
  expect_refused("a.glb", good.substr(0, good.size() - 1), fmt::format("byte {}", good.size() - 60), "within a chunk");
  expect_refused("a.glb", good.substr(0, 12), "", "syntax error");
  refused({.nodes = R"([{"mesh":1}])"}, "array index 1 is out of range");
  refused({.nodes = R"([{"children":[0]}])"}, "contains itself");
  refused({.nodes = R"([{"children":[1,1]},{"children":[0,0]}])"}, "contains itself");
  refused({.nodes = R"([{"children":[9]}])"}, "array index 9 is out of range");
  refused({.nodes = R"([{"mesh":0,"scale":[1,2]}])"}, "expected 3 numbers");
  refused({.nodes = R"([{"mesh":0,"scale":[1e39,1,1]}])"}, "expected finite coordinates", "vertex 1");
  refused({.mode = "[]"}, "expected a whole number from 0 to 4294967295, found array");
  refused({.indices = R"({"bufferView":1,"componentType":5121,"count":13,"type":"SCALAR"})"}, "beyond the data");
  refused({.indices = R"({"bufferView":1,"componentType":5121,"count":4294967295,"type":"SCALAR"})"},
          "beyond the data");
  refused({.indices = R"({"bufferView":0,"componentType":5125,"count":12,"type":"SCALAR"})"},
          "expected the index of one of the 4 vertices", "triangle 1");
  refused({.positions = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{}})"}, "sparse");
  refused({.positions = R"({"componentType":5126,"count":4,"type":"VEC3"})"}, "key 'bufferView' not found");
  refused({.positions = R"({"bufferView":0,"componentType":5121,"count":4,"type":"VEC3"})"}, "single precision");
  refused({.view = R"({"buffer":0,"byteOffset":40,"byteLength":48})"}, "beyond the data");
  refused({.view = R"({"buffer":0,"byteOffset":-1,"byteLength":48})"}, "found -1");
  refused({.buffer = R"({"byteLength":60,"uri":"/etc/passwd"})"}, "in the file itself");
  std::string levels;
  for (int i = 0; i < 200'000; ++i) levels += '[';
  refused({.nodes = levels}, "syntax error");
}

}  // namespace
}  // namespace cloud2csg
