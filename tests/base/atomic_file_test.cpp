#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

using testing_support::TemporaryFolder;

std::ptrdiff_t entries_in(const TemporaryFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator());
}

TEST(AtomicFile, AppearsWithItsContentOnCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder / "out.txt");
  file.write("one ");
  file.write(std::string("two\0three", 9));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.txt"));
  file.commit();
  EXPECT_EQ(read_text_file(folder / "out.txt"), std::string("one two\0three", 13));
  EXPECT_EQ(entries_in(folder), 1);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  { AtomicFile(folder / "out.txt").write("lost"); }
  EXPECT_EQ(entries_in(folder), 0);
}

TEST(AtomicFile, KeepsTheOldContentWithoutCommit) {
  const TemporaryFolder folder;
  write_text_file(folder / "out.txt", "old");
  { AtomicFile(folder / "out.txt").write("new"); }
  EXPECT_EQ(read_text_file(folder / "out.txt"), "old");
  write_text_file(folder / "out.txt", "new");
  EXPECT_EQ(read_text_file(folder / "out.txt"), "new");
  EXPECT_EQ(entries_in(folder), 1);
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotMix) {
  const TemporaryFolder folder;
  AtomicFile first(folder / "out.txt");
  AtomicFile second(folder / "out.txt");
  first.write("first");
  second.write("second");
  second.commit();
  first.commit();
  EXPECT_EQ(read_text_file(folder / "out.txt"), "first");
  EXPECT_EQ(entries_in(folder), 1);
}

TEST(AtomicFile, FollowsALink) {
  const TemporaryFolder folder;
  write_text_file(folder / "real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  write_text_file(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_text_file(folder / "real.txt"), "new");
}

TEST(AtomicFile, WritesDevicesDirectly) {
  EXPECT_NO_THROW(write_text_file("/dev/null", "gone"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, RefusesAMissingFolderNamingTheFile) {
  const TemporaryFolder folder;
  const std::filesystem::path target = folder / "missing/out.txt";
  try {
    write_text_file(target, "text");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, target.string());
    EXPECT_NE(error.parts().expected.find("No such file or directory"), std::string::npos);
    EXPECT_FALSE(error.parts().remedy.empty());
  }
}

TEST(AtomicFile, RefusesAFolderAsTarget) {
  const TemporaryFolder folder;
  EXPECT_THROW(AtomicFile file(folder.path()), Error);
  EXPECT_EQ(entries_in(folder), 0);
}

TEST(AtomicFile, ReportsAFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_text_file("/dev/full", "text"), Error);
}

TEST(ReadTextFile, RefusesWhatIsMissingOrAFolder) {
  const TemporaryFolder folder;
  try {
    (void)read_text_file(folder / "none.txt");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().file, (folder / "none.txt").string());
    EXPECT_NE(error.parts().expected.find("No such file or directory"), std::string::npos);
  }
  EXPECT_THROW((void)read_text_file(folder.path()), Error);
}

TEST(ReadTextFile, ReadsAnEmptyFile) {
  const TemporaryFolder folder;
  write_text_file(folder / "empty.txt", "");
  EXPECT_EQ(read_text_file(folder / "empty.txt"), "");
}

}  // namespace
}  // namespace cloud2csg
