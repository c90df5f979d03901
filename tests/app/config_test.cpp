#include <algorithm>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

class Config : public ProgramTest {
 protected:
  /// What `command` prints as its configuration with these arguments.
  [[nodiscard]] std::string printed(std::vector<std::string> arguments) {
    arguments.emplace_back("--print-config");
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  }
};

TEST_F(Config, PrintsEachGroupOnceAndTrueDefaults) {
  const std::string text = printed({"extract"});
  const std::size_t fit = text.find("\n## Fit\n");
  ASSERT_NE(fit, std::string::npos) << text;
  EXPECT_EQ(text.find("\n## Fit\n", fit + 1), std::string::npos) << text;
  EXPECT_NE(text.find("\n# strangers = false\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n# polish = true\n"), std::string::npos) << text;
}

TEST_F(Config, WhatIsPrintedIsReadAsTheSame) {
  const std::vector<std::vector<std::string>> all{
      {"extract"},
      {"extract", "--seed", "7", "--leaf-cost", "1e-05", "--no-seeds", "--polish", "--no-snap", "--refine", "--preset",
       "paper", "--stats", "a \"b\" #c.json", "-o", "x.scad", "-o", "it's.json"},
      {"extract", "--beta", ".5", "--strategy", "cells", "--quiet", "--threads", "2"},
      {"detect", "-o", "5"},
      {"sample"},
      {"sample", "--density", "0.25"},
      {"scan"},
      {"scan", "--perfect"},
      {"bench", "scaling", "--primitives", "10", "20", "--family", "grid"},
      {"bench", "paper"}};
  for (const std::vector<std::string>& given : all) {
    const std::string text = printed(given);
    const std::string config = file("round.toml", text);
    std::vector<std::string> again(given.begin(), given.begin() + (given[0] == "bench" ? 2 : 1));
    again.insert(again.end(), {"--config", config});
    EXPECT_EQ(printed(again), text);
  }
}

TEST_F(Config, PrintedValuesAreThoseInForce) {
  const std::string text = printed({"extract", "--seed", "18446744073709551615", "--no-seeds", "-o", "a.scad"});
  for (const char* line : {"[extract]\n", "\nseed = \"18446744073709551615\"\n", "\nseeds = false\n",
                           "\noutput = \"a.scad\"\n", "\npreset = \"default\"\n", "\npopulation = 150\n",
                           "\nrefine = false\n", "\n# polish = true\n", "\nthreads = 0\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << " is not in\n" << text;
  }
}

TEST_F(Config, AFileGivesWhatTheCommandLineDoesNot) {
  const std::string config = file("c.toml", "quiet = true\n[sample]\ncount = 10\nseed = 3  # of all\noutput = [\"" +
                                                path("a.xyz") + "\"]\n[scan]\nviews = 3\n");
  ASSERT_EQ(run({"sample", shipped("m1.json"), "--config", config}).status, 0);
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "10", "--seed", "3", "-o", path("b.xyz")}).status, 0);
  EXPECT_EQ(read_file(path("a.xyz")), read_file(path("b.xyz")));

  // The command line wins, also where it excludes what the file gives.
  ASSERT_EQ(run({"sample", shipped("m1.json"), "--config", config, "-n", "20", "-o", path("c.xyz")}).status, 0);
  const std::string larger = read_file(path("c.xyz"));
  EXPECT_EQ(std::count(larger.begin(), larger.end(), '\n'), 20);
  EXPECT_EQ(run({"sample", shipped("m1.json"), "--config", config, "--density", "30", "-o", path("d.xyz")}).status, 0);
  EXPECT_NE(printed({"extract", "--config", file("e.toml", "[extract]\nseeds = false\n"), "--seeds"})
                .find("\nseeds = true\n"),
            std::string::npos);
}

TEST_F(Config, WrongNamesAreRefusedWithTheNearest) {
  const auto refused = [this](const std::string& text, const std::vector<std::string>& parts) {
    const std::string config = file("c.toml", text);
    expect_failure(run({"extract", "c.ply", "-o", path("x.json"), "--config", config}), 2, parts);
  };
  refused("[extract]\n\nleafcost = 1\n", {"c.toml:3: unknown option 'leafcost'; did you mean 'leaf-cost'?"});
  refused("[extrct]\nseed = 1\n", {"c.toml:1: unknown command 'extrct'; did you mean 'extract'?"});
  refused("thread = 1\n", {"c.toml:1: unknown option 'thread'; did you mean 'threads'?"});
  refused("[detect]\nsed = 1\n", {"c.toml:2: unknown option 'sed'; did you mean 'seed'?"});
  refused("[bench.papr]\n", {"c.toml:1: unknown command 'papr'; did you mean 'paper'?"});
  refused("[extract]\nprint-config = true\n", {"unknown option 'print-config'"});
  refused("[extract]\nseed = \n", {"c.toml:2: not valid TOML"});
}

TEST_F(Config, WrongValuesAreRefused) {
  const auto refused = [this](const std::string& line, const std::vector<std::string>& parts) {
    const std::string config = file("c.toml", "[extract]\n" + line + "\n");
    expect_failure(run({"extract", "c.ply", "-o", path("x.json"), "--config", config}), 2, parts);
  };
  refused("seed = -1", {"c.toml:2: seed: expected a whole number", "'-1'"});
  refused("strategy = \"magic\"", {"c.toml:2: strategy: expected one of", "'magic'"});
  refused("leaf-cost = inf", {"c.toml:2: leaf-cost: expected a number above 0"});
  refused("refine = 1", {"c.toml:2: refine: expected true or false"});
  refused("seed = true", {"c.toml:2: seed: expected text, a number"});
  refused("seed = [1, 2]", {"seed: given more than once"});
  refused("seeds = true\nno-seeds = true", {"--seeds", "--no-seeds"});
  expect_failure(run({"extract", "c.ply", "-o", path("x.json"), "--config", path("none.toml")}), 2, {"none.toml"});
}

}  // namespace
}  // namespace cloud2csg::test
