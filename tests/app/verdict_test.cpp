#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

/// How extract and detect end: the verdict, the exit status, the files and the line of JSON.
namespace cloud2csg::test {
namespace {

using nlohmann::json;

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) last = line;
  return last;
}

class Verdict : public ProgramTest {
 protected:
  /// A model file of a box and, with `ball`, a ball beside it.
  std::string box(const std::string& name, bool ball) {
    json model = {{"format", "cloud2csg"},
                  {"version", 1},
                  {"primitives", {{{"id", "box"}, {"type", "box"}, {"size", {2, 2, 2}}}}},
                  {"tree", {{"primitive", "box"}}}};
    if (ball) {
      model["primitives"].push_back(
          {{"id", "ball"}, {"type", "sphere"}, {"radius", 0.5}, {"pose", {{"position", {2, 0, 0}}}}});
      model["tree"] = {{"op", "union"}, {"children", {{{"primitive", "box"}}, {{"primitive", "ball"}}}}};
    }
    return file(name, model.dump());
  }

  void sample(const std::string& model, const std::string& cloud) {
    ASSERT_EQ(run({"sample", model, "-n", "5000", "--noise", "0.002", "-o", path(cloud), "-q"}).status, 0);
  }
};

TEST_F(Verdict, OfAGoodResultIsTheLastLine) {
  sample(box("box.json", true), "c.ply");
  const Outcome loud = run({"extract", path("c.ply"), "-o", path("t.scad")});
  EXPECT_EQ(loud.status, 0) << loud.err;
  EXPECT_EQ(last_line(loud.err).find("good: 9"), 0U) << loud.err;
  EXPECT_EQ(loud.out, "");
  EXPECT_NE(read_file(path("t.scad")).find("// " + last_line(loud.err)), std::string::npos);

  const Outcome quiet = run({"extract", path("c.ply"), "-q", "-o", path("t.scad")});
  EXPECT_EQ(quiet.err, last_line(loud.err) + "\n");
}

TEST_F(Verdict, DoubtfulResultsAreWrittenWithStatus3) {
  sample(box("both.json", true), "c.ply");
  const Outcome outcome = run({"extract", path("c.ply"), "--primitives", box("box.json", false), "--json", "-o",
                               path("t.json"), "-o", path("t.scad"), "--stats", path("s.json")});
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_EQ(last_line(outcome.err).find("doubtful: "), 0U) << outcome.err;
  EXPECT_NE(outcome.err.find("\nunexplained: "), std::string::npos);
  json line = json::parse(outcome.out);
  EXPECT_EQ(line["grade"], "doubtful");
  EXPECT_EQ(line["text"], last_line(outcome.err));
  EXPECT_EQ(line["files"], json({path("t.json"), path("t.scad"), path("s.json")}));
  EXPECT_EQ(line["regions"].size(), 1U);
  line.erase("files");
  EXPECT_EQ(json::parse(read_file(path("s.json")))["verdict"], line);
}

TEST_F(Verdict, NothingIsWrittenOfAFailedResult) {
  sample(box("both.json", true), "c.ply");
  json far = json::parse(read_file(box("far.json", false)));
  // It shares one face with the box of the cloud; the other points are on nothing.
  far["primitives"][0]["size"] = {2, 2, 9};
  far["primitives"][0]["pose"] = {{"position", {0, 0, 5.5}}};
  const Outcome outcome = run({"extract", path("c.ply"), "--primitives", file("far.json", far.dump()), "--json", "-o",
                               path("t.json"), "--stats", path("s.json")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_EQ(last_line(outcome.err).find("failed: "), 0U) << outcome.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"both.json", "c.ply", "far.json"}));
  const json line = json::parse(outcome.out);
  EXPECT_EQ(line["grade"], "failed");
  EXPECT_TRUE(line["files"].empty());
}

TEST_F(Verdict, ThatCannotBeWrittenIsAFailure) {
  sample(box("both.json", true), "c.ply");
  const std::string command = "'" CLOUD2CSG_PROGRAM "' extract '" + path("c.ply") + "' --primitives '" +
                              box("box.json", false) + "' --json -q -o '" + path("t.json") + "' >/dev/full 2>'" +
                              path("err") + "'; echo $? >'" + path("status") + "'";
  ASSERT_EQ(run({"--version"}, command).status, 0);
  EXPECT_EQ(read_file(path("status")), "1\n");
  EXPECT_NE(read_file(path("err")).find("standard output cannot be written"), std::string::npos);
}

TEST_F(Verdict, QuietRunsStillWarn) {
  sample(box("both.json", true), "c.ply");
  const json model = {
      {"format", "cloud2csg"},
      {"version", 1},
      {"primitives", {{{"id", "ghost"}, {"type", "sphere"}, {"radius", 0.2}, {"pose", {{"position", {9, 9, 9}}}}}}}};
  const Outcome outcome = run({"extract", path("c.ply"), "--primitives", file("ghost.json", model.dump()),
                               "--detect-rest", "-q", "-o", path("t.json")});
  EXPECT_NE(outcome.err.find("warning: the points do not support the known primitive 'ghost'"), std::string::npos)
      << outcome.err;
}

TEST_F(Verdict, OfAnErrorIsJsonToo) {
  const Outcome outcome = run({"extract", path("none.ply"), "--json", "-o", path("t.json")});
  EXPECT_EQ(outcome.status, 1);
  const json line = json::parse(outcome.out);
  EXPECT_EQ(line["grade"], "failed");
  for (const char* figure : {"points", "share_within", "distance", "unexplained_points", "disagreement"}) {
    EXPECT_TRUE(line[figure].is_null()) << figure;
  }
  EXPECT_EQ("cloud2csg: " + line["text"].get<std::string>().substr(std::string("failed: ").size()) + "\n", outcome.err);
  EXPECT_TRUE(line["files"].empty());
}

TEST_F(Verdict, WarningsComeBeforeAnError) {
  std::string sheet;  // whose normals are all wrong
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) sheet += std::to_string(i) + " " + std::to_string(j) + " 0 1 0 0\n";
  }
  const Outcome outcome = run({"extract", file("sheet.xyz", sheet), "-q", "-o", path("t.json")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err.find("warning: "), 0U) << outcome.err;
  EXPECT_NE(outcome.err.find("\ncloud2csg: " + path("sheet.xyz")), std::string::npos) << outcome.err;
}

TEST_F(Verdict, OfDetectFollowsItsTable) {
  sample(box("box.json", true), "c.ply");
  const Outcome good = run({"detect", path("c.ply"), "--json", "-q", "-o", path("p.json")});
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_EQ(good.err.find("good: "), 0U) << good.err;
  EXPECT_EQ(json::parse(last_line(good.out))["files"], json({path("p.json")}));
  EXPECT_NE(good.out.find("sphere "), std::string::npos);

  std::string sheet;
  for (int i = 0; i < 2500; ++i)
    sheet += std::to_string(0.1 * (i % 50)) + " " + std::to_string(0.1 * (i / 50)) + " 0\n";
  const Outcome flat = run({"detect", file("sheet.xyz", sheet), "-q", "-o", path("s.json")});
  EXPECT_EQ(flat.status, 3) << flat.err;
  EXPECT_NE(last_line(flat.err).find("the surfaces bound no solid"), std::string::npos) << flat.err;
  EXPECT_EQ(flat.out.find("plane "), 0U) << flat.out;
  EXPECT_TRUE(json::parse(read_file(path("s.json")))["primitives"].empty());
}

}  // namespace
}  // namespace cloud2csg::test
