#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "base/temporary_folder.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

using testing_support::TemporaryFolder;

std::set<std::string> names_in(const TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

auto writing(std::string text) {
  return [text = std::move(text)](const std::filesystem::path& path) { write_text_file(path, text); };
}

TEST(OutputSet, FilesAppearTogetherOnCommit) {
  const TemporaryFolder folder;
  write_text_file(folder / "b.txt", "old");
  OutputSet outputs;
  outputs.add(folder / "a.txt", writing("a"));
  outputs.add(folder / "b.txt", writing("b"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  EXPECT_EQ(read_text_file(folder / "b.txt"), "old");
  outputs.commit();
  EXPECT_EQ(read_text_file(folder / "a.txt"), "a");
  EXPECT_EQ(read_text_file(folder / "b.txt"), "b");
  EXPECT_EQ(names_in(folder), (std::set<std::string>{"a.txt", "b.txt"}));
}

TEST(OutputSet, WithoutCommitNothingHasHappened) {
  const TemporaryFolder folder;
  write_text_file(folder / "b.txt", "old");
  {
    OutputSet outputs;
    outputs.add(folder / "a.txt", writing("a"));
    outputs.add(folder / "b.txt", writing("b"));
  }
  EXPECT_EQ(read_text_file(folder / "b.txt"), "old");
  EXPECT_EQ(names_in(folder), std::set<std::string>{"b.txt"});
}

TEST(OutputSet, WritersSeeTheEndingOfTheTarget) {
  const TemporaryFolder folder;
  OutputSet outputs;
  outputs.add(folder / "a.b.Ply", [&](const std::filesystem::path& path) {
    EXPECT_EQ(path.extension(), ".Ply");
    EXPECT_EQ(path.parent_path(), folder.path());
    EXPECT_NE(path, folder / "a.b.Ply");
  });
}

TEST(OutputSet, ErrorsNameTheTarget) {
  const TemporaryFolder folder;
  const auto file_of_error = [](OutputSet& outputs, const std::filesystem::path& target, const auto& write) {
    try {
      outputs.add(target, write);
    } catch (const Error& error) {
      return error.parts().file;
    }
    return std::string("no error");
  };
  OutputSet outputs;
  const auto fail = [](const std::filesystem::path& path) { throw Error({.file = path.string(), .expected = "no"}); };
  const auto fail_elsewhere = [](const std::filesystem::path& /*path*/) {
    throw Error({.file = "elsewhere", .expected = "no"});
  };
  const std::filesystem::path target = folder / "a.txt";
  EXPECT_EQ(file_of_error(outputs, target, fail), target.string());
  EXPECT_EQ(file_of_error(outputs, target, fail_elsewhere), "elsewhere");
  EXPECT_EQ(file_of_error(outputs, folder / "no/a.txt", writing("a")), (folder / "no/a.txt").string());
  EXPECT_EQ(file_of_error(outputs, folder.path(), writing("a")), folder.path().string());
}

TEST(OutputSet, WhatIsInPlaceIsTakenBackWhenAnotherFails) {
  const TemporaryFolder folder;
  write_text_file(folder / "old.txt", "old");
  std::filesystem::create_directory(folder / "sub");
  {
    OutputSet outputs;
    outputs.add(folder / "new.txt", writing("new"));
    outputs.add(folder / "old.txt", writing("new"));
    outputs.add(folder / "sub/c.txt", writing("new"));
    std::filesystem::remove_all(folder / "sub");
    try {
      outputs.commit();
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().file, (folder / "sub/c.txt").string());
    }
  }
  EXPECT_EQ(read_text_file(folder / "old.txt"), "old");
  EXPECT_EQ(names_in(folder), std::set<std::string>{"old.txt"});
}

TEST(OutputSet, FollowsALink) {
  const TemporaryFolder folder;
  write_text_file(folder / "real.txt", "old");
  std::filesystem::create_symlink(folder / "real.txt", folder / "link.txt");
  OutputSet outputs;
  outputs.add(folder / "link.txt", writing("new"));
  outputs.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_text_file(folder / "real.txt"), "new");
}

TEST(OutputSet, WritesDevicesDirectly) {
  OutputSet outputs;
  outputs.add("/dev/null", [](const std::filesystem::path& path) { EXPECT_EQ(path, "/dev/null"); });
  outputs.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

/// In a process of its own, since nothing but its end may follow remove_temporaries().
TEST(TemporaryFileDeathTest, AllAreRemovedForASignal) {
  const TemporaryFolder folder;
  const auto end_while_writing = [&folder] {
    const AtomicFile direct(folder / "direct.txt");
    OutputSet outputs;
    outputs.add(folder / "a.txt", writing("a"));
    outputs.add(folder / "b.txt", [&](const std::filesystem::path& path) {
      const AtomicFile inner(path);
      // What was dropped before is not in the way.
      { const TemporaryFile dropped(folder / "dropped.txt"); }
      const int status = names_in(folder).size() == 4 ? 3 : 4;  // the test must not pass for want of files
      remove_temporaries();
      std::_Exit(status);
    });
  };
  EXPECT_EXIT(end_while_writing(), ::testing::ExitedWithCode(3), "");
  EXPECT_EQ(names_in(folder), std::set<std::string>{});
}

}  // namespace
}  // namespace cloud2csg
