#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

/// What detect writes, and what somebody knows: --primitives with --detect-rest, --radii, --axes, sizes.
namespace cloud2csg::test {
namespace {

using nlohmann::json;

class Known : public ProgramTest {
 protected:
  static constexpr const char* k_block = R"({"id": "block", "type": "box", "size": [4, 3, 1]})";
  static constexpr const char* k_bore =
      R"({"id": "bore", "type": "cylinder", "radius": 0.5, "height": 3, "pose": {"position": [-1, 0.4, 0]}})";

  std::string model(const std::string& name, const std::string& primitives, const std::string& tree = "") {
    return file(name, R"({"format": "cloud2csg", "version": 1, "primitives": [)" + primitives + "]" +
                          (tree.empty() ? "" : ", \"tree\": " + tree) + "}");
  }
  /// A block with a bore.
  std::string block() {
    return model("block.json", std::string(k_block) + "," + k_bore,
                 R"({"op": "difference", "children": [{"primitive": "block"}, {"primitive": "bore"}]})");
  }
  std::string cloud_of(const std::string& truth) {
    EXPECT_EQ(run({"sample", truth, "-n", "12000", "--noise", "0.004", "-o", path("c.ply")}).status, 0);
    return path("c.ply");
  }
};

TEST_F(Known, DetectWritesHowManyPointsLieOnEachSolid) {
  const Outcome outcome = run({"detect", cloud_of(block()), "-o", path("p.json")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json model = json::parse(read_file(path("p.json")));
  ASSERT_EQ(model["primitives"].size(), 1U) << "an extrusion with a hole";
  std::size_t points = 0;
  for (const json& primitive : model["primitives"]) {
    points += primitive["evidence"]["points"].get<std::size_t>();
    EXPECT_NEAR(primitive["evidence"]["rms"].get<double>(), 0.004, 0.001);
  }
  EXPECT_GT(points, 11'500U);
  EXPECT_LE(points, 12'000U);
}

TEST_F(Known, DetectWritesThePointsInTheColoursOfTheirSolids) {
  const Outcome outcome = run({"detect", cloud_of(block()), "-o", path("p.json"), "-o", path("points.ply")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json model = json::parse(read_file(path("p.json")));
  const std::string text = read_file(path("points.ply"));
  const std::size_t begin = text.find("end_header\n") + 11;
  ASSERT_NE(text.substr(0, begin).find("property uchar blue\n"), std::string::npos);
  constexpr std::size_t k_record = 6 * 8 + 3;  // position, normal, colour
  ASSERT_EQ((text.size() - begin) % k_record, 0U);
  std::map<std::string, std::size_t> count_of_colour;
  for (std::size_t at = begin; at < text.size(); at += k_record) ++count_of_colour[text.substr(at + 48, 3)];
  std::multiset<std::size_t> counts;
  for (const auto& [colour, count] : count_of_colour) {
    if (colour != "\x96\x96\x96") counts.insert(count);
  }
  std::multiset<std::size_t> expected;
  for (const json& primitive : model["primitives"]) {
    expected.insert(primitive["evidence"]["points"].get<std::size_t>());
  }
  EXPECT_EQ(counts, expected);
  // It is a cloud like others.
  EXPECT_EQ(run({"extract", path("points.ply"), "--primitives", path("p.json"), "-o", path("t.json")}).status, 0);
}

TEST_F(Known, ExtractGetsTheFreeFormOfM1RightWhenItIsKnown) {
  const json m1 = json::parse(read_file(shipped("m1.json")));
  const std::string known = model("known.json", m1["primitives"][0].dump());
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "50000", "--noise", "0.01", "-o", path("c.ply")}).status, 0);
  const Outcome outcome = run({"extract", path("c.ply"), "--primitives", known, "--detect-rest", "-o", path("t.json")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("known        1 primitive, "), std::string::npos) << outcome.err;
  EXPECT_GT(iou(shipped("m1.json"), path("t.json")), 0.99);
  json first = json::parse(read_file(path("t.json")))["primitives"][0];
  first.erase("evidence");
  EXPECT_EQ(first, m1["primitives"][0]);
}

TEST_F(Known, DetectKeepsWhatIsKnown) {
  const std::string cloud = cloud_of(block());
  const std::string known =
      model("known.json", std::string(k_block) + R"(,{"id": "ghost", "type": "sphere", "radius": 0.2,
      "pose": {"position": [0, 0, 3]}})");
  const Outcome outcome = run({"detect", cloud, "--primitives", known, "-o", path("p.json")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << "the wall of the bore: " << outcome.out;
  const json primitives = json::parse(read_file(path("p.json")))["primitives"];
  ASSERT_EQ(primitives.size(), 3U);
  EXPECT_EQ(primitives[0]["id"], "block");
  EXPECT_EQ(primitives[0]["size"], json({4, 3, 1}));
  EXPECT_EQ(primitives[1]["evidence"]["points"], 0);
  EXPECT_NE(outcome.err.find("warning: the points do not support the known primitive 'ghost': 0 of"), std::string::npos)
      << outcome.err;
}

TEST_F(Known, RadiiAreTakenAndOthersNoted) {
  const std::string cloud = cloud_of(block());
  const auto radius_with = [&](const std::string& radii) {
    const Outcome outcome = run({"detect", cloud, "--radii", radii, "--no-snap", "-o", path("p.json")});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const json model = json::parse(read_file(path("p.json")));
    for (const json& primitive : model["primitives"]) {
      for (const json& path : primitive["profile"]) {
        if (path.size() != 2) continue;  // two halves of a circle
        const double width = std::hypot(path[0][0].get<double>() - path[1][0].get<double>(),
                                        path[0][1].get<double>() - path[1][1].get<double>());
        return std::pair(0.5 * width, outcome.err.find("none of the given ones") != std::string::npos);
      }
    }
    return std::pair(0.0, false);
  };
  const auto [given, is_other] = radius_with("0.2,0.5,3");
  EXPECT_NEAR(given, 0.5, 1e-12);
  EXPECT_FALSE(is_other);
  const auto [radius, is_noted] = radius_with("0.2,0.6");
  EXPECT_NEAR(radius, 0.5, 0.005);
  EXPECT_GT(std::abs(radius - 0.5), 1e-9);
  EXPECT_TRUE(is_noted);
}

TEST_F(Known, AxesAndSizesReachTheDetection) {
  const std::string cloud = cloud_of(block());
  const Outcome outcome = run({"detect", cloud, "--axes", "x,y", "--axes", "0,0,-2", "--max-size", "2", "--no-snap",
                               "--primitives", model("known.json", k_block), "--detect-rest", "-o", path("p.json")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json bore = json::parse(read_file(path("p.json")))["primitives"][1];
  EXPECT_EQ(bore["type"], "cylinder");
  const auto quaternion = bore["pose"]["quaternion"].get<std::array<double, 4>>();
  const double along_z = 1 - 2 * (quaternion[1] * quaternion[1] + quaternion[2] * quaternion[2]);
  EXPECT_NEAR(std::abs(along_z), 1, 1e-12);
  expect_failure(run({"detect", cloud, "--min-size", "50", "-o", path("q.json"), "-q"}), 1, {"c.ply"});
}

TEST_F(Known, NonsenseIsWrongUsage) {
  const std::string cloud = file("few.xyz", "0 0 0\n");
  const auto refuses = [&](const std::vector<std::string>& options, const std::vector<std::string>& parts) {
    for (const char* command : {"extract", "detect"}) {
      std::vector<std::string> arguments{command, cloud, "-o", path("t.json")};
      arguments.insert(arguments.end(), options.begin(), options.end());
      expect_failure(run(arguments), 2, parts);
    }
  };
  refuses({"--radii", "2,-1"}, {"--radii", "above 0", "-1"});
  refuses({"--radii", "2,x"}, {"--radii", "'x'"});
  refuses({"--axes", "x,w"}, {"--axes", "'x,w'", "x,y,1,1,0"});
  refuses({"--axes", "1,1"}, {"--axes", "'1,1'"});
  refuses({"--axes", "0,0,0"}, {"--axes"});
  refuses({"--axes", "nan,0,1"}, {"--axes"});
  refuses({"--min-size", "0"}, {"--min-size"});
  refuses({"--max-size", "inf"}, {"--max-size"});
  refuses({"--min-size", "3", "--max-size", "2"}, {"--min-size", "--max-size", "3 and 2"});
  refuses({"--detect-rest"}, {"--detect-rest", "--primitives"});
  expect_failure(run({"extract", cloud, "-o", path("t.json"), "--primitives", block(), "--detect-rest", "--refine"}), 2,
                 {"--refine", "--detect-rest"});
  expect_failure(run({"detect", cloud, "-o", path("few.xyz")}), 2, {".json .ply"});
  expect_failure(run({"detect", cloud, "--primitives", path("few.xyz"), "-o", path("t.json"), "-q"}), 1, {"few.xyz"});
}

}  // namespace
}  // namespace cloud2csg::test
