#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <stop_token>

#include "clouds/cloud_support.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

/// A small file of each kind, valid.
std::vector<std::pair<std::string, std::string>> valid_files() {
  std::vector<std::pair<std::string, std::string>> files;
  for (const char* name : {"a.ply", "a.pcd", "a.xyz", "a.xyzn", "a.pts"}) {
    for (const bool binary : {false, true}) {
      const bool has_binary_form = std::string_view(name) == "a.ply" || std::string_view(name) == "a.pcd";
      if (binary && !has_binary_form) continue;
      const TemporaryFolder folder;
      write_point_cloud(folder / name, small_scan(), {.binary = binary});
      files.emplace_back(name, read_text_file(folder / name));
    }
  }
  files.emplace_back("lists.ply", std::string("ply\nformat binary_little_endian 1.0\nelement face 1\n"
                                              "property list uchar uchar v\nelement vertex 2\n"
                                              "property list int uchar t\nproperty char x\nproperty char y\n"
                                              "property char z\nend_header\n") +
                                      "\x02" + "ab" + raw<std::int32_t>(1) + "t123" + raw<std::int32_t>(0) + "123");
  files.emplace_back("c.pcd",
                     "FIELDS x y z\nSIZE 1 1 1\nTYPE U U U\nCOUNT 1 1 1\nPOINTS 4\n"
                     "DATA binary_compressed\n" +
                         raw<std::uint32_t>(5) + raw<std::uint32_t>(12) +
                         std::string("\x01"
                                     "12\xe0\x01",
                                     5));
  return files;
}

/// Reads; a refusal must be an Error with the file's name. True when a cloud came out.
bool survives(const std::filesystem::path& file) {
  try {
    const PointCloud cloud = read_point_cloud(file);
    EXPECT_GT(cloud.size(), 0U);
    EXPECT_TRUE(!cloud.has_normals() || cloud.normals.size() == cloud.size());
    EXPECT_TRUE(!cloud.has_sensor_positions() || cloud.sensor_positions.size() == cloud.size());
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, file.string());
    EXPECT_FALSE(error.parts().expected.empty());
    return false;
  }
}

TEST(Read, EveryTruncationIsRefusedOrStillACloud) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : valid_files()) {
    std::size_t refused = 0;
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      put_file(folder / name, std::string_view(bytes).substr(0, length));
      if (!survives(folder / name)) ++refused;
    }
    EXPECT_GT(refused, 0U) << name;
  }
}

TEST(Read, EveryFlippedByteIsRefusedOrStillACloud) {
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : valid_files()) {
    std::size_t refused = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      for (const char replacement : {'9', '\xff'}) {
        std::string changed = bytes;
        changed[at] = replacement;
        put_file(folder / name, changed);
        if (!survives(folder / name)) ++refused;
      }
    }
    EXPECT_GT(refused, 0U) << name;
  }
}

TEST(Read, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.ply");
  const auto message_of = [](const std::filesystem::path& file) -> std::string {
    try {
      (void)read_point_cloud(file);
      return "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, file.string());
      return error.parts().expected;
    }
  };
  EXPECT_NE(message_of(folder / "none.ply").find("No such file or directory"), std::string::npos);
  EXPECT_NE(message_of(folder / "folder.ply").find("directory"), std::string::npos);
  for (const char* name : {"cloud.las", "cloud"}) std::ofstream(folder / name) << "0 0 0\n";
  EXPECT_NE(message_of(folder / "cloud.las").find(".ply .pcd .xyz .txt .xyzn .pts"), std::string::npos);
  EXPECT_NE(message_of(folder / "cloud").find(".ply .pcd .xyz .txt .xyzn .pts"), std::string::npos);
}

TEST(Read, HonoursTheStopToken) {
  std::stop_source stop;
  stop.request_stop();
  const RunContext run{.stop = stop.get_token()};
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.pcd", "a.xyz", "a.pts"}) {
    write_point_cloud(folder / name, small_cloud());
    EXPECT_THROW((void)read_point_cloud(folder / name, run), Cancelled) << name;
  }
}

TEST(Read, ReportsProgressToTheEnd) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ply", "a.pcd", "a.xyz", "a.pts"}) {
    write_point_cloud(folder / name, small_cloud());
    Progress last;
    const RunContext run{.on_progress = [&last](const Progress& progress) { last = progress; }};
    (void)read_point_cloud(folder / name, run);
    EXPECT_EQ(last.stage, "read") << name;
    EXPECT_EQ(last.done, 3U) << name;
    EXPECT_EQ(last.total, 3U) << name;
  }
}

}  // namespace
}  // namespace cloud2csg
