#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "clouds/cloud_support.hpp"
#include "io/clouds/lzf.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

/// A plain LZF compressor: the longest match within 8 k, found by trying all.
std::string compress_lzf(std::string_view data) {
  std::string out;
  std::string literals;
  const auto flush = [&] {
    for (std::size_t i = 0; i < literals.size(); i += 32) {
      const std::string_view run = std::string_view(literals).substr(i, 32);
      out += static_cast<char>(run.size() - 1);
      out += run;
    }
    literals.clear();
  };
  for (std::size_t i = 0; i < data.size();) {
    std::size_t best_length = 0, best_distance = 0;
    for (std::size_t distance = 1; distance <= std::min<std::size_t>(i, 8192); ++distance) {
      std::size_t length = 0;
      while (length < 264 && i + length < data.size() && data[i + length] == data[i + length - distance]) ++length;
      if (length > best_length) best_length = length, best_distance = distance;
    }
    if (best_length < 3) {
      literals += data[i++];
      continue;
    }
    flush();
    const std::size_t code = best_length - 2, offset = best_distance - 1;
    out += static_cast<char>(std::min<std::size_t>(code, 7) << 5U | offset >> 8U);
    if (code >= 7) out += static_cast<char>(code - 7);
    out += static_cast<char>(offset & 255U);
    i += best_length;
  }
  flush();
  return out;
}

RC_GTEST_PROP(Lzf, GivesBackWhatWasCompressed, ()) {
  // Few different letters, so that there is something to repeat.
  const auto text = *rc::gen::container<std::string>(rc::gen::element('a', 'b', '\0'));
  std::string data = text + text + text;
  if (*rc::gen::arbitrary<bool>()) data += std::string(700, 'r');
  const std::string compressed = compress_lzf(data);
  RC_ASSERT(decompress_lzf(compressed, data.size()) == data);
  RC_ASSERT(!decompress_lzf(compressed, data.size() + 1));
  if (!data.empty()) RC_ASSERT(!decompress_lzf(compressed, data.size() - 1));
}

RC_GTEST_PROP(Lzf, RefusesOrDecodesAnyBytes, (const std::string& bytes)) {
  const auto size = *rc::gen::inRange<std::size_t>(0, 300);
  const std::optional<std::string> result = decompress_lzf(bytes, size);
  if (result) RC_ASSERT(result->size() == size);
}

TEST(Lzf, RefusesAnAbsurdSizeAtOnce) {
  EXPECT_FALSE(decompress_lzf("abc", std::size_t{1} << 60));
}

std::string header(std::string_view fields, std::string_view size, std::string_view type, std::string_view count,
                   std::string_view points, std::string_view data) {
  std::string text = "# .PCD v0.7\nVERSION 0.7\n";
  const auto line = [&text](std::string_view keyword, std::string_view values) {
    text += std::string(keyword) + " " + std::string(values) + "\n";
  };
  line("FIELDS", fields);
  line("SIZE", size);
  line("TYPE", type);
  line("COUNT", count);
  line("WIDTH", points);
  line("HEIGHT", "1");
  line("VIEWPOINT", "0 0 0 1 0 0 0");
  line("POINTS", points);
  line("DATA", data);
  return text;
}

std::string plain_header(std::string_view points, std::string_view data) {
  return header("x y z", "4 4 4", "F F F", "1 1 1", points, data);
}

TEST(Pcd, AsciiWithOtherFields) {
  const std::string head = header("rgb x y descriptor z normal_x normal_y normal_z curvature", "4 4 8 4 4 4 4 4 4",
                                  "U F F F F F F F F", "1 1 1 3 1 1 1 1 1", "2", "ascii");
  expect_equal(read_bytes("a.pcd", head + "7 1 2 9 9 9 3 0 0 2 0.5\n7 4 5 9 9 9 6 -1 0 0 0.5\n"),
               make_cloud({{1, 2, 3}, {4, 5, 6}}, {{0, 0, 1}, {-1, 0, 0}}));
}

TEST(Pcd, BinaryWithPaddingAndWholeNumbers) {
  const std::string head = header("x _ y z", "4 1 8 2", "F U F I", "1 3 1 1", "2", "binary");
  const std::string data =
      raw(1.5F) + "..." + raw(2.5) + raw<std::int16_t>(-3) + raw(4.0F) + "..." + raw(5.0) + raw<std::int16_t>(6);
  expect_equal(read_bytes("a.pcd", head + data), make_cloud({{1.5, 2.5, -3}, {4, 5, 6}}));
}

TEST(Pcd, CompressedFieldAfterField) {
  std::string x, y, z, w;
  std::vector<std::array<double, 3>> positions;
  for (int i = 0; i < 50; ++i) {
    positions.push_back({i * 0.5, 7.0, -2.0 * i});
    x += raw(static_cast<float>(positions.back()[0]));
    y += raw(static_cast<float>(positions.back()[1]));
    z += raw(static_cast<float>(positions.back()[2]));
    w += "ww";
  }
  const std::string records = x + w + y + z;
  const std::string compressed = compress_lzf(records);
  EXPECT_LT(compressed.size(), records.size());
  const std::string head = header("x w y z", "4 1 4 4", "F U F F", "1 2 1 1", "50", "binary_compressed");
  const std::string sizes =
      raw(static_cast<std::uint32_t>(compressed.size())) + raw(static_cast<std::uint32_t>(records.size()));
  expect_equal(read_bytes("a.pcd", head + sizes + compressed), make_cloud(positions));

  const std::string where = "byte " + std::to_string(head.size());
  expect_refused("a.pcd", head + sizes + compressed.substr(0, 20), where, "ends after 20 bytes");
  expect_refused("a.pcd", head + sizes + std::string(compressed.size(), '\xff'), where, "damaged");
  expect_refused("a.pcd", head + raw<std::uint32_t>(10) + raw<std::uint32_t>(10) + "0123456789", where,
                 "expected 700 bytes");
  expect_refused("a.pcd", head + "abc", where, "announces 50 points but ends after 0");
}

std::string with_viewpoint(std::string_view viewpoint) {
  std::string text = plain_header("2", "ascii") + "1 2 3\n4 5 6\n";
  constexpr std::string_view k_unknown = "VIEWPOINT 0 0 0 1 0 0 0";
  return text.replace(text.find(k_unknown), k_unknown.size(), "VIEWPOINT " + std::string(viewpoint));
}

TEST(Pcd, ViewpointIsTheSensorOfAllPoints) {
  PointCloud expected = make_cloud({{1, 2, 3}, {4, 5, 6}});
  expect_equal(read_bytes("a.pcd", with_viewpoint("0 0 0 1 0 0 0")), expected);
  for (int i = 0; i < 2; ++i) expected.sensor_positions.push_back({0.5, -7, 1e3});
  expect_equal(read_bytes("a.pcd", with_viewpoint("0.5 -7 1e3 1 0 0 0")), expected);
  for (const std::size_t i : {0U, 1U}) expected.sensor_positions.set(i, {0, 0, 0});
  expect_equal(read_bytes("a.pcd", with_viewpoint("0 0 0 0 1 0 0")), expected);
  expect_refused("a.pcd", with_viewpoint("0 0 0"), "line 9", "VIEWPOINT");
  expect_refused("a.pcd", with_viewpoint("0 0 nan 1 0 0 0"), "line 9", "VIEWPOINT");
}

TEST(Pcd, FieldsOfSensorPositionsGoBeforeTheViewpoint) {
  std::string head = header("x y z vp_x vp_y vp_z", "4 4 4 4 4 4", "F F F F F F", "1 1 1 1 1 1", "1", "ascii");
  head.replace(head.find("VIEWPOINT 0"), 11, "VIEWPOINT 9");
  PointCloud expected = make_cloud({{1, 2, 3}});
  expected.sensor_positions.push_back({4, 5, 6});
  expect_equal(read_bytes("a.pcd", head + "1 2 3 4 5 6\n"), expected);
}

TEST(Pcd, PointsFollowFromWidthAndHeight) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n";
  expect_equal(read_bytes("a.pcd", head + "1 2 3\n4 5 6\n"), make_cloud({{1, 2, 3}, {4, 5, 6}}));
}

TEST(Pcd, RefusesBadHeadersNamingTheLine) {
  expect_refused("a.pcd", "", "line 1", "no DATA line");
  expect_refused("a.pcd", "hello\n", "line 1", "expected VERSION");
  expect_refused("a.pcd", "FIELDS\n", "line 1", "expected values after FIELDS");
  expect_refused("a.pcd", "DATA ascii\n", "line 1", "no FIELDS");
  expect_refused("a.pcd", plain_header("1", "gzip"), "line 11", "DATA ascii, binary or binary_compressed");
  expect_refused("a.pcd", header("x y z", "4 4", "F F F", "1 1 1", "1", "ascii"), "line 4", "each of the 3 fields");
  expect_refused("a.pcd", header("x y z", "4 4 3", "F F F", "1 1 1", "1", "ascii"), "line 5", "TYPE F with SIZE");
  expect_refused("a.pcd", header("x y z", "4 4 4", "F F F", "1 1 -1", "1", "ascii"), "line 6", "COUNT");
  expect_refused("a.pcd", header("x y w", "4 4 4", "F F F", "1 1 1", "1", "ascii"), "line 3", "no z");
  expect_refused("a.pcd", plain_header("lots", "ascii"), "line 10", "POINTS");
  std::string disagree = plain_header("6", "ascii");
  disagree.replace(disagree.find("WIDTH 6"), 7, "WIDTH 5");
  expect_refused("a.pcd", disagree, "line 10", "WIDTH times HEIGHT");
}

TEST(Pcd, RefusesBadData) {
  expect_refused("a.pcd", plain_header("2", "ascii") + "1 2 3\n1 2 x\n", "line 13", "found \"x\"");
  expect_refused("a.pcd", plain_header("2", "ascii") + "1 2 3\n1 2\n", "line 13", "found 2");
  expect_refused("a.pcd", plain_header("2", "ascii") + "1 2 3\n1 2 nan\n", "line 13", "finite");
  expect_refused("a.pcd", plain_header("2", "ascii") + "1 2 3\n", "line 12", "announces 2 points but ends after 1");
  expect_refused("a.pcd", plain_header("1", "ascii") + "1 2 3\n1 2 3\n", "line 13", "no more than the announced 1");
  expect_refused("a.pcd", plain_header("0", "ascii"), "", "holds no points");
  const std::string binary = plain_header("2", "binary");
  expect_refused("a.pcd", binary + std::string(20, '\0'), "byte " + std::to_string(binary.size() + 12),
                 "announces 2 points but ends after 1");
}

}  // namespace
}  // namespace cloud2csg
