#include "io/clouds/ply.hpp"

#include <gtest/gtest.h>

#include "clouds/cloud_support.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

TEST(Ply, AsciiWithCommentsExtraPropertiesListsAndOtherElements) {
  const PointCloud cloud = read_bytes("a.ply",
                                      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\n"
                                      "element camera 1\r\nproperty list uchar float k\r\n"
                                      "element vertex 2\r\nproperty uchar red\r\nproperty float nx\r\n"
                                      "property float ny\r\nproperty float nz\r\nproperty list uchar int tags\r\n"
                                      "property double z\r\nproperty double y\r\nproperty double x\r\n"
                                      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
                                      "3 9 9 9\r\n"
                                      "255 0 0 2 2 7 8 3 2 1\r\n"
                                      "255 0 3 0 0 6 5 4\r\n"
                                      "3 0 1 0\r\n");
  expect_equal(cloud, make_cloud({{1, 2, 3}, {4, 5, 6}}, {{0, 0, 1}, {0, 1, 0}}));
}

TEST(Ply, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement thing 2\nproperty short a\nproperty char b\nelement vertex 2\n"
                        "property float x\nproperty double y\nproperty int z\nproperty uchar red\nend_header\n";
    bytes += "123123";
    bytes += raw(1.5F, big) + raw(-2.25, big) + raw<std::int32_t>(-7, big) + "r";
    bytes += raw(0.5F, big) + raw(1e300, big) + raw<std::int32_t>(70000, big) + "r";
    expect_equal(read_bytes("a.ply", bytes), make_cloud({{1.5, -2.25, -7}, {0.5, 1e300, 70000}}));
  }
}

TEST(Ply, BinaryWithListsInAndBeforeTheVertices) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement face 2\nproperty list uchar ushort v\nelement vertex 2\n"
      "property list uint uchar tags\nproperty float x\nproperty float y\nproperty float z\n"
      "property list uchar float weights\nend_header\n";
  bytes += std::string("\x02") + "abcd" + std::string("\x00", 1);
  bytes += raw<std::uint32_t>(3, true) + "tag" + raw(1.0F, true) + raw(2.0F, true) + raw(3.0F, true) +
           std::string("\x00", 1);
  bytes += raw<std::uint32_t>(0, true) + raw(4.0F, true) + raw(5.0F, true) + raw(6.0F, true) + "\x01" + "wwww";
  expect_equal(read_bytes("a.ply", bytes), make_cloud({{1, 2, 3}, {4, 5, 6}}));
}

constexpr std::string_view k_xyz = "property float x\nproperty float y\nproperty float z\n";

std::string ascii_ply(std::string_view count, std::string_view rows) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::string(count) + "\n" + std::string(k_xyz) + "end_header\n" +
         std::string(rows);
}

TEST(Ply, RefusesBadHeadersNamingTheLine) {
  expect_refused("a.ply", "", "line 1", "end_header");
  expect_refused("a.ply", "poly\n", "line 1", R"(expected "ply")");
  expect_refused("a.ply", "ply\nformat ascii 2.0\n", "line 2", R"(expected "format", then "ascii 1.0")");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex many\n", "line 3", "element <name> <count>");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", "line 3", "element <name> <count>");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nproperty float x\n", "line 3", "element before");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty text x\n", "line 4", "expected a type");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nvertices 3\n", "line 3", "expected element");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "line 4", "no end_header");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nend_header\n", "line 3", "vertex");
  expect_refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n",
                 "line 3", "no z");
  expect_refused("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(k_xyz) + "property float nx\nend_header\n",
                 "line 3", "all three coordinates of the normal");
}

TEST(Ply, ReadsSensorPositions) {
  const std::string fields = "property float sensor_z\nproperty float sensor_x\nproperty double sensor_y\n";
  PointCloud expected = make_cloud({{1, 2, 3}, {4, 5, 6}});
  expected.sensor_positions.push_back({8, 9, 7});
  expected.sensor_positions.push_back({-2, -3, -1});
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\n" + std::string(k_xyz);
  expect_equal(read_bytes("a.ply", head + fields + "end_header\n1 2 3 7 8 9\n4 5 6 -1 -2 -3\n"), expected);
  expect_refused("a.ply", head + fields + "end_header\n1 2 3 7 8 9\n4 5 6 nan 1 1\n", "line 12",
                 "finite position of the sensor");
  expect_refused("a.ply", head + "property float sensor_x\nend_header\n1 2 3 7\n4 5 6 1\n", "line 3",
                 "all three coordinates of the sensor's position");
}

TEST(Ply, RefusesBadAsciiDataNamingTheLine) {
  expect_refused("a.ply", ascii_ply("2", "1 2 3\n1 two 3\n"), "line 9", "found \"two\"");
  expect_refused("a.ply", ascii_ply("2", "1 2 3\n1 2 3 4\n"), "line 9", "found 4 columns");
  expect_refused("a.ply", ascii_ply("2", "1 2 3\n1 2\n"), "line 9", "found 2 columns");
  expect_refused("a.ply", ascii_ply("2", "1 2 3\n1 2 nan\n"), "line 9", "finite");
  expect_refused("a.ply", ascii_ply("2", "1 2 3\n1 -inf 2\n"), "line 9", "finite");
  expect_refused("a.ply", ascii_ply("3", "1 2 3\n1 2 3\n"), "line 9", "announces 3 points but ends after 2");
  expect_refused("a.ply", ascii_ply("0", ""), "", "holds no points");
  expect_refused("a.ply", ascii_ply("99999999999999999", "1 2 3\n"), "line 8", "announces 99999999999999999 points");
}

std::string binary_ply(std::string_view count, std::string_view data, std::string_view properties = k_xyz) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::string(count) + "\n" + std::string(properties) +
         "end_header\n" + std::string(data);
}

TEST(Ply, RefusesBadBinaryDataNamingTheByte) {
  const std::string point = raw(1.0F) + raw(2.0F) + raw(3.0F);
  const std::string bad = raw(1.0F) + raw(std::numeric_limits<float>::infinity()) + raw(3.0F);
  const std::size_t header = binary_ply("2", "").size();
  const auto byte = [](std::size_t number) { return "byte " + std::to_string(number); };
  expect_refused("a.ply", binary_ply("2", point + bad), byte(header + 12), "finite");
  expect_refused("a.ply", binary_ply("2", point + "abc"), byte(header + 12), "announces 2 points but ends after 1");
  expect_refused("a.ply", binary_ply("0", ""), "", "holds no points");
  const std::string with_list = std::string(k_xyz) + "property list int uchar tags\n";
  const std::size_t list_header = binary_ply("1", "", with_list).size();
  expect_refused("a.ply", binary_ply("1", point + raw<std::int32_t>(-1), with_list), byte(list_header),
                 "announces 1 points but ends after 0");
  const std::string normals = std::string(k_xyz) + "property float nx\nproperty float ny\nproperty float nz\n";
  expect_refused("a.ply", binary_ply("1", point + std::string(12, '\0'), normals),
                 byte(binary_ply("1", "", normals).size()), "length zero");
}

}  // namespace
}  // namespace cloud2csg
