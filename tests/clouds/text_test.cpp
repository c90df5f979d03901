#include <gtest/gtest.h>

#include "clouds/cloud_support.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

TEST(Xyz, AcceptsCommentsBlankLinesSeparatorsAndSigns) {
  expect_equal(read_bytes("a.xyz", "# made by hand\n\n 1 2 3 \r\n// more\n+4,5e0;\t-6.0"),
               make_cloud({{1, 2, 3}, {4, 5, -6}}));
  expect_equal(read_bytes("a.TXT",
                          "\xEF\xBB\xBF"
                          "1 2 3\n"),
               make_cloud({{1, 2, 3}}));
}

TEST(Xyz, SixColumnsAreNormalsOfAnyLength) {
  const PointCloud expected = make_cloud({{1, 2, 3}, {4, 5, 6}}, {{0, 0, 1}, {0, -1, 0}});
  expect_equal(read_bytes("a.xyz", "1 2 3 0 0 9\n4 5 6 0 -1e-320 0\n"), expected);
  expect_equal(read_bytes("a.xyzn", "1 2 3 0 0 1e300\n4 5 6 0 -1 0\n"), expected);
}

TEST(Xyz, RefusesBadRowsNamingTheLine) {
  expect_refused("a.xyz", "", "", "holds no points");
  expect_refused("a.xyz", "# only a comment\n", "", "holds no points");
  expect_refused("a.xyz", "x y z\n1 2 3\n", "line 1", "found \"x\"");
  expect_refused("a.xyz", "1 2 3\n\n1 2 3,5x\n", "line 3", "found \"5x\"");
  expect_refused("a.xyz", "1 2 3\n1 2 3 4\n", "line 2", "expected 3 columns as in the rows before, found 4");
  expect_refused("a.xyz", "1 2\n", "line 1", "expected 3 columns (x y z) or 6 (x y z nx ny nz), found 2");
  expect_refused("a.xyz", "1 2 1e999\n", "line 1", "found \"1e999\"");
  expect_refused("a.xyz", "1 2 NaN\n", "line 1", "finite");
  expect_refused("a.xyz", "1 2 3 0 0 0\n", "line 1", "length zero");
  expect_refused("a.xyz", "1 2 3 0 nan 0\n", "line 1", "expected a normal that is finite");
  expect_refused("a.xyzn", "1 2 3\n", "line 1", "expected 6 columns");
  expect_refused("a.xyzn", "", "", "holds no points");
  expect_refused("a.xyz", std::string("1 2 \x01\0\x7f", 7), "line 1", "found \"\\x01\\x00\\x7f\"");
}

TEST(Pts, WithAndWithoutIntensityAndColour) {
  const PointCloud expected = make_cloud({{1, 2, 3}, {4, 5, 6}});
  expect_equal(read_bytes("a.pts", "2\n1 2 3\n4 5 6\n"), expected);
  expect_equal(read_bytes("a.pts", "2\n1 2 3 -700\n4 5 6 12\n"), expected);
  expect_equal(read_bytes("a.pts", "2\n1 2 3 0.5 255 0 0\n4 5 6 0.5 0 255 0\n"), expected);
}

TEST(Pts, RefusesBadFilesNamingTheLine) {
  expect_refused("a.pts", "", "", "holds no points");
  expect_refused("a.pts", "0\n", "", "holds no points");
  expect_refused("a.pts", "1 2 3\n", "line 1", "number of points");
  expect_refused("a.pts", "2\n1 2 3\n", "line 2", "announces 2 points but ends after 1");
  expect_refused("a.pts", "1\n1 2 3\n4 5 6\n", "line 3", "no more than the announced 1");
  expect_refused("a.pts", "1\n1 2 3 4 5\n", "line 2", "3, 4 or 7 columns");
}

}  // namespace
}  // namespace cloud2csg
