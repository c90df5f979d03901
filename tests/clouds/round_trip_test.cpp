#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "clouds/cloud_support.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

PointCloud round_trip(const std::string& name, const PointCloud& cloud, const CloudWriteOptions& options = {}) {
  const TemporaryFolder folder;
  write_point_cloud(folder / name, cloud, options);
  return read_point_cloud(folder / name);
}

/// Any finite double: the whole range of exponents, not only the small numbers that rapidcheck likes.
rc::Gen<double> any_finite() {
  return rc::gen::map(rc::gen::suchThat(rc::gen::arbitrary<std::uint64_t>(),
                                        [](std::uint64_t bits) { return (bits >> 52U & 0x7ffU) != 0x7ffU; }),
                      [](std::uint64_t bits) {
                        double value = 0.0;
                        std::memcpy(&value, &bits, sizeof value);
                        return value;
                      });
}

PointCloud any_cloud(bool with_normals, bool with_sensors = false) {
  PointCloud cloud;
  const auto count = *rc::gen::inRange<std::size_t>(1, 20);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.positions.push_back({*any_finite(), *any_finite(), *any_finite()});
    // Few values, so that all points may have been seen from one place, the origin among them.
    const auto coordinate = rc::gen::element(0.0, 0.1, -1e300);
    if (with_sensors) cloud.sensor_positions.push_back({*coordinate, 0.0, 0.0});
    if (!with_normals) continue;
    Eigen::Vector3d direction(*rc::gen::inRange(-1000, 1000), *rc::gen::inRange(-1000, 1000), 1.0);
    cloud.normals.push_back(direction.normalized());
  }
  return cloud;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

bool same_bits(const PointCloud& a, const PointCloud& b) {
  return same_bits(a.positions.x, b.positions.x) && same_bits(a.positions.y, b.positions.y) &&
         same_bits(a.positions.z, b.positions.z) && same_bits(a.normals.x, b.normals.x) &&
         same_bits(a.normals.y, b.normals.y) && same_bits(a.normals.z, b.normals.z) &&
         same_bits(a.sensor_positions.x, b.sensor_positions.x) &&
         same_bits(a.sensor_positions.y, b.sensor_positions.y) && same_bits(a.sensor_positions.z, b.sensor_positions.z);
}

RC_GTEST_PROP(RoundTrip, KeepsEveryBitInEveryFormat, ()) {
  const auto name = *rc::gen::element<std::string>("a.ply", "a.PLY", "a.pcd", "a.xyz", "a.txt");
  const CloudWriteOptions options{.binary = *rc::gen::arbitrary<bool>()};
  const PointCloud cloud = any_cloud(*rc::gen::arbitrary<bool>());
  RC_ASSERT(same_bits(round_trip(name, cloud, options), cloud));
}

RC_GTEST_PROP(RoundTrip, KeepsEveryBitOfSensorPositionsInPlyAndPcd, ()) {
  const auto name = *rc::gen::element<std::string>("a.ply", "a.pcd");
  const CloudWriteOptions options{.binary = *rc::gen::arbitrary<bool>()};
  const PointCloud cloud = any_cloud(*rc::gen::arbitrary<bool>(), true);
  RC_ASSERT(same_bits(round_trip(name, cloud, options), cloud));
}

TEST(RoundTrip, TextLeavesSensorPositionsOut) {
  for (const char* name : {"a.xyz", "a.xyzn", "a.txt"}) expect_equal(round_trip(name, small_scan()), small_cloud());
}

RC_GTEST_PROP(RoundTrip, KeepsEveryBitInXyzn, ()) {
  const PointCloud cloud = any_cloud(true);
  RC_ASSERT(same_bits(round_trip("a.xyzn", cloud), cloud));
}

RC_GTEST_PROP(RoundTrip, PtsKeepsEveryBitOfThePositions, ()) {
  PointCloud cloud = any_cloud(*rc::gen::arbitrary<bool>());
  const PointCloud back = round_trip("a.pts", cloud);
  cloud.normals = {};
  RC_ASSERT(same_bits(back, cloud));
}

TEST(RoundTrip, SinglePrecisionKeepsWhatAFloatHolds) {
  const PointCloud cloud = small_cloud();
  for (const char* name : {"a.ply", "a.pcd", "a.xyz"}) {
    for (const bool binary : {false, true}) {
      const PointCloud back = round_trip(name, cloud, {.binary = binary, .double_precision = false});
      ASSERT_EQ(back.size(), cloud.size());
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        EXPECT_EQ(static_cast<float>(back.positions.x[i]), static_cast<float>(cloud.positions.x[i])) << name;
        EXPECT_LT((back.positions[i] - cloud.positions[i]).norm(), 1e-7 * cloud.positions[i].norm()) << name;
        EXPECT_LT((back.normals[i] - cloud.normals[i]).norm(), 1e-7) << name;
        EXPECT_NEAR(back.normals[i].norm(), 1.0, 1e-15) << name;
      }
    }
  }
}

TEST(Write, BinaryIsSmallerThanText) {
  const TemporaryFolder folder;
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.positions.push_back({std::sin(i), std::cos(i), std::sqrt(i)});
  write_point_cloud(folder / "b.ply", cloud);
  write_point_cloud(folder / "t.ply", cloud, {.binary = false});
  EXPECT_LT(std::filesystem::file_size(folder / "b.ply"), std::filesystem::file_size(folder / "t.ply"));
}

TEST(Write, RefusesUnknownEndings) {
  const TemporaryFolder folder;
  try {
    write_point_cloud(folder / "a.las", small_cloud());
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(error.parts().expected.find(".ply .pcd .xyz .txt .xyzn .pts"), std::string::npos);
  }
}

TEST(Write, RefusesXyznWithoutNormals) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_point_cloud(folder / "a.xyzn", make_cloud({{1, 2, 3}})), Error);
}

TEST(Write, RefusesASensorThatIsNowhere) {
  const TemporaryFolder folder;
  PointCloud cloud = make_cloud({{1, 2, 3}});
  cloud.sensor_positions.push_back({0, 0, std::numeric_limits<double>::infinity()});
  for (const char* name : {"a.ply", "a.pcd"}) EXPECT_THROW(write_point_cloud(folder / name, cloud), Error) << name;
}

TEST(Write, LeavesNoFileForNumbersThatCannotBeWritten) {
  const TemporaryFolder folder;
  const PointCloud no_number = make_cloud({{1, 2, std::numeric_limits<double>::quiet_NaN()}});
  const PointCloud too_large = make_cloud({{1, 2, 1e300}});
  EXPECT_THROW(write_point_cloud(folder / "a.ply", no_number), Error);
  try {
    write_point_cloud(folder / "b.ply", too_large, {.double_precision = false});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, (folder / "b.ply").string());
    EXPECT_EQ(error.parts().remedy, "write in double precision");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Write, RefusesAMissingFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_point_cloud(folder / "none/a.ply", small_cloud()), Error);
}

}  // namespace
}  // namespace cloud2csg
