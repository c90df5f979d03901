#pragma once

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/point_cloud.hpp"

namespace cloud2csg::testing_support {

[[nodiscard]] inline PointCloud make_cloud(const std::vector<std::array<double, 3>>& positions,
                                           const std::vector<std::array<double, 3>>& normals = {}) {
  PointCloud cloud;
  for (const auto& p : positions) cloud.positions.push_back({p[0], p[1], p[2]});
  for (const auto& n : normals) cloud.normals.push_back(Eigen::Vector3d(n[0], n[1], n[2]).normalized());
  return cloud;
}

/// Three points with normals, none of them a round number.
[[nodiscard]] inline PointCloud small_cloud() {
  return make_cloud({{0.1, -2.0 / 3.0, 1e-17}, {1e5 / 7.0, 3.0, -0.0}, {-5.25, 1.0 / 3.0, 12345.678901234567}},
                    {{1, 2, 3}, {-0.5, 0.1, 0.7}, {0, 0, -1}});
}

/// The same with a sensor each, two of them in one place.
[[nodiscard]] inline PointCloud small_scan() {
  PointCloud cloud = small_cloud();
  for (const double x : {1.0 / 3.0, -1e9, 1.0 / 3.0}) cloud.sensor_positions.push_back({x, 0.1, 7.0});
  return cloud;
}

inline void expect_equal(const Points& a, const Points& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
}

inline void expect_equal(const PointCloud& a, const PointCloud& b) {
  expect_equal(a.positions, b.positions);
  expect_equal(a.normals, b.normals);
  expect_equal(a.sensor_positions, b.sensor_positions);
}

/// Writes a file without waiting for the disk, as the library's own writer does: there are thousands of them.
inline void put_file(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::remove(file);  // ext4 waits for the disk when a file is cut to nothing and written again
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// The cloud that a file of this name and content holds.
[[nodiscard]] inline PointCloud read_bytes(const std::string& name, std::string_view bytes) {
  const TemporaryFolder folder;
  put_file(folder / name, bytes);
  return read_point_cloud(folder / name);
}

/// Expects reading to fail with these parts of the message.
inline void expect_refused(const std::string& name, std::string_view bytes, std::string_view where,
                           std::string_view expected) {
  const TemporaryFolder folder;
  put_file(folder / name, bytes);
  try {
    (void)read_point_cloud(folder / name);
    FAIL() << "was read: " << bytes.substr(0, 60);
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, (folder / name).string());
    EXPECT_EQ(error.parts().where, where) << error.what();
    EXPECT_NE(error.parts().expected.find(expected), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

/// The bytes of a number in memory.
template <typename T>
[[nodiscard]] std::string raw(T value, bool reversed = false) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
  return reversed ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

}  // namespace cloud2csg::testing_support
