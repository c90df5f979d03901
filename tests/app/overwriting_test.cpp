#include "app/program.hpp"
#include "cloud2csg/report.hpp"

namespace cloud2csg::test {
namespace {

class Overwriting : public ProgramTest {};

/// Endings that models are written with here.
std::vector<std::string> endings() {
  std::vector<std::string> endings{".json", ".scad", ".csg", ".FCMacro", ".py", ".stl", ".off", ".obj", ".dot", ".png"};
  if (has_report_page()) endings.emplace_back(".html");
  return endings;
}

TEST_F(Overwriting, TakesFilesOfItsOwnKindAndEmptyOnes) {
  for (const std::string& ending : endings()) {
    const std::string out = file("m" + ending, "");
    for (int k = 0; k < 2; ++k) {
      const Outcome written = run({"convert", shipped("m1.json"), "-o", out});
      EXPECT_EQ(written.status, 0) << ending << written.err;
    }
    EXPECT_GT(std::filesystem::file_size(out), 20U) << ending;
  }
}

TEST_F(Overwriting, LeavesOtherFilesAlone) {
  const std::string work = std::string("PK\x03\x04 somebody's work") + '\0';
  for (const std::string& ending : endings()) {
    if (ending == ".stl") continue;  // begins with anything
    const std::string out = file("work" + ending, work);
    const Outcome refused = run({"convert", shipped("m1.json"), "-o", out});
    EXPECT_EQ(refused.status, 1) << ending;
    EXPECT_NE(refused.err.find("work" + ending + ": is there already and is no "), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("choose another name"), std::string::npos) << refused.err;
  }
  const std::string package = file("package.json", "{\n  \"name\": \"somebody's\"\n}\n");
  EXPECT_EQ(run({"convert", shipped("m1.json"), "-o", package}).status, 1);
  EXPECT_NE(read_file(package).find("somebody's"), std::string::npos);
  for (const std::string ending : {".json", ".off", ".png"}) {
    EXPECT_EQ(run({"convert", shipped("m1.json"), "-o", file("notes" + ending, "my notes")}).status, 1) << ending;
  }
}

TEST_F(Overwriting, ModelsMayBeWithoutSpaces) {
  const std::string older = file("compact.json", R"({"format":"cloud2csg","version":1,"primitives":[]})");
  const Outcome written = run({"convert", shipped("m1.json"), "-o", older});
  EXPECT_EQ(written.status, 0) << written.err;
}

TEST_F(Overwriting, StatisticsTakeTheirOwnKind) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "500", "-o", path("c.ply")}).status, 0);
  for (int k = 0; k < 2; ++k) {
    const Outcome written = run({"extract", path("c.ply"), "--primitives", shipped("m1.json"), "-o", path("m.json"),
                                 "--stats", path("s.json")});
    EXPECT_EQ(written.status, 0) << written.err;
  }
}

TEST_F(Overwriting, CloudsTakeTheirOwnKind) {
  for (const std::string ending : {".ply", ".pcd", ".xyz"}) {
    const std::string out = path("c" + ending);
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(run({"sample", shipped("m1.json"), "-n", "50", "-o", out}).status, 0) << ending;
    }
  }
  const Outcome refused = run({"sample", shipped("m1.json"), "-n", "50", "-o", file("p.ply", "my notes")});
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("is there already and is no PLY file"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace cloud2csg::test
