#include "cloud2csg/advanced/colour.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "clouds/cloud_support.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

/// What viewer/src/colours.ts gives for the light theme.
TEST(PrimitiveColour, IsThatOfTheReport) {
  EXPECT_EQ(primitive_colour(0), (Colour{203, 98, 87}));
  EXPECT_EQ(primitive_colour(1), (Colour{54, 191, 144}));
  EXPECT_EQ(primitive_colour(2), (Colour{130, 91, 178}));
  EXPECT_EQ(primitive_colour(3), (Colour{176, 123, 0}));
  EXPECT_EQ(primitive_colour(7), (Colour{133, 159, 249}));
  EXPECT_EQ(primitive_colour(40), (Colour{139, 180, 83}));
}

TEST(PrimitiveColour, TellsPrimitivesApart) {
  for (std::size_t a = 0; a < 100; ++a) {
    const Colour one = primitive_colour(a);
    EXPECT_FALSE(one == k_no_primitive_colour);
    for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(one == primitive_colour(b)) << a << " and " << b;
  }
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Ply, KeepsItsPointsUnderColours) {
  const std::vector<Colour> colours{{1, 2, 3}, {0, 128, 255}, {10, 13, 32}};
  const TemporaryFolder folder;
  for (const bool binary : {true, false}) {
    write_point_cloud(folder / "c.ply", small_scan(), {.binary = binary, .colours = colours});
    expect_equal(read_point_cloud(folder / "c.ply"), small_scan());
    EXPECT_NE(bytes_of(folder / "c.ply").find("property uchar red\nproperty uchar green\nproperty uchar blue\n"),
              std::string::npos);
  }
  EXPECT_NE(bytes_of(folder / "c.ply").find(" 0 128 255\n"), std::string::npos);
  write_point_cloud(folder / "c.pcd", small_scan(), {.colours = colours});
  expect_equal(read_point_cloud(folder / "c.pcd"), small_scan());
}

}  // namespace
}  // namespace cloud2csg
