#include <algorithm>
#include <regex>
#include <sstream>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using Usage = ProgramTest;

TEST_F(Usage, VersionIsAResult) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.rfind("cloud2csg ", 0), 0U) << outcome.out;
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Usage, HelpListsWhatThereIs) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* command : {"extract", "sample", "scan", "compare", "convert", "info", "bench"}) {
    EXPECT_NE(outcome.out.find(command), std::string::npos) << command;
    const Outcome help = run({command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_NE(help.out.find("Example:\n  cloud2csg " + std::string(command)), std::string::npos) << help.out;
  }
}

TEST_F(Usage, HelpShowsDefaults) {
  EXPECT_NE(run({"sample", "--help"}).out.find("10000"), std::string::npos);
  EXPECT_NE(run({"compare", "--help"}).out.find("100000"), std::string::npos);
}

TEST_F(Usage, NothingToDoIsWrongUsage) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("extract"), std::string::npos);
}

TEST_F(Usage, UnknownNamesSuggestTheNearest) {
  expect_failure(run({"extrct"}), 2, {"unknown command 'extrct'", "did you mean 'extract'?"});
  expect_failure(run({"extract", "c.ply", "--primitve", "m.json", "-o", "x.json"}), 2,
                 {"unknown option '--primitve'", "did you mean '--primitives'?", "extract --help"});
  expect_failure(run({"sample", "m.json", "--nosie=0.1", "-o", "x.ply"}), 2, {"'--nosie'", "did you mean '--noise'?"});
  expect_failure(run({"sample", "m.json", "--ouptut", "x.ply"}), 2, {"did you mean '--output'?"});
}

TEST_F(Usage, FarNamesSuggestNothing) {
  const Outcome outcome = run({"sample", "m.json", "-o", "x.ply", "--zebra"});
  expect_failure(outcome, 2, {"unknown option '--zebra'"});
  EXPECT_EQ(outcome.err.find("did you mean"), std::string::npos) << outcome.err;
}

TEST_F(Usage, EveryValueOfEveryCommandIsChecked) {
  // "--name TYPE" or "--name TYPE=default" in the help: options with a value. Few names are numbers, no number is -x.
  const std::regex option_line(R"(^  (?:-\w,)?(--[a-z-]+) [A-Z](?:[^a-z]|$))");
  for (const std::string command : {"extract", "sample", "scan", "compare", "convert"}) {
    std::istringstream help(run({command, "--help"}).out);
    std::size_t options = 0;
    for (std::string line; std::getline(help, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, option_line)) continue;
      const std::string option = match[1];
      ++options;
      expect_failure(run({command, option, ""}), 2, {option + ": expected"});
      expect_failure(run({command, option}), 2, {option + ": expected"});
      if (option == "--output" || option == "--stats" || option == "--unexplained" || option == "--primitives" ||
          option == "--config")
        continue;
      for (const char* value : {"-x", "1e999", "nan", "1x"}) {
        expect_failure(run({command, option, value}), 2, {option + ": expected", "'" + std::string(value) + "'"});
      }
    }
    EXPECT_GE(options, 4U) << command;
  }
}

TEST_F(Usage, WholeNumbersAreDecimal) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "010", "-o", path("x.xyz"), "--quiet"}).status, 0);
  const std::string cloud = read_file(path("x.xyz"));
  EXPECT_EQ(std::count(cloud.begin(), cloud.end(), '\n'), 10);
}

struct OutOfRange {
  std::vector<std::string> options;
  std::string message;
};

TEST_F(Usage, WhatTheExtractionRefusesNamesTheOption) {
  for (const OutOfRange& given :
       {OutOfRange{{"--elites", "200"}, "--elites: expected fewer than the population (150), found 200"},
        OutOfRange{{"--population", "2"}, "--elites: expected fewer than the population (2), found 2"},
        OutOfRange{{"--population", "1"}, "--population: expected a whole number of 2 or more, found 1"},
        OutOfRange{{"--tournament", "0"}, "--tournament: expected"},
        OutOfRange{{"--height-limit", "0"}, "--height-limit: expected"},
        OutOfRange{{"--idle-generations", "0"}, "--idle-generations: expected"},
        OutOfRange{{"--generation-limit", "0"}, "--generation-limit: expected"},
        OutOfRange{{"--listing-limit", "6"}, "--listing-limit: expected a whole number from 0 to 5, found 6"},
        OutOfRange{{"--distance-tolerance", "0"}, "--distance-tolerance: expected"},
        OutOfRange{{"--angle-tolerance", "91"},
                   "--angle-tolerance: expected a number above 0 and at most 90, found 91"},
        OutOfRange{{"--seed", "-1"}, "--seed: expected a whole number of 0 or more, found '-1'"},
        OutOfRange{{"--least-points", "0"}, "--least-points: expected a whole number of 1 or more, found 0"},
        OutOfRange{{"--azimuth", "1e308"}, "--azimuth: expected a number from -360 to 360"},
        OutOfRange{{"--beta", "0"}, "--beta: expected"}, OutOfRange{{"--gamma", "0"}, "--gamma: expected"},
        OutOfRange{{"--time-limit", "0"}, "--time-limit: expected"}}) {
    std::vector<std::string> arguments{"extract", "c.ply", "--primitives", "m.json", "-o", path("x.json")};
    arguments.insert(arguments.end(), given.options.begin(), given.options.end());
    expect_failure(run(arguments), 2, {given.message});
  }
}

TEST_F(Usage, ValuesAreChecked) {
  const std::string model = shipped("m1.json");
  const std::string out = path("x.ply");
  expect_failure(run({"sample", model}), 2, {"--output"});
  expect_failure(run({"sample", "-o", out}), 2, {"shape"});
  expect_failure(run({"sample", model, "-o"}), 2, {"--output"});
  expect_failure(run({"sample", model, "-o", out, "-n", "0"}), 2, {"--count"});
  expect_failure(run({"sample", model, "-o", out, "-n", "many"}), 2, {"--count", "many"});
  expect_failure(run({"sample", model, "-o", out, "--noise", "-0.1"}), 2, {"--noise", "-0.1"});
  expect_failure(run({"sample", model, "-o", out, "--noise", "nan"}), 2, {"--noise", "nan"});
  expect_failure(run({"sample", model, "-o", out, "extra"}), 2, {"extra"});
  expect_failure(run({"sample", model, "-o", out, "-n", "5", "-n", "6"}), 2, {"--count: given more than once"});
  expect_failure(run({"sample", model, "-o", out, "-n", "5", "--density", "6"}), 2, {"--count", "--density"});
  expect_failure(run({"sample", model, "-o", ""}), 2, {"--output: expected the name of a file"});
  expect_failure(run({"sample", "", "-o", out}), 2, {"shape: expected the name of a file"});
  for (const auto& [option, value] : {std::pair{"--distance", "0.5"}, std::pair{"--field-of-view", "171"},
                                      std::pair{"--angular-step", "171"}, std::pair{"--grazing-angle", "90"}}) {
    expect_failure(run({"scan", model, "-o", out, option, value}), 2, {option, "expected a number from", value});
  }
  for (const auto& [option, value] : {std::pair{"--picture-width", "15"}, std::pair{"--picture-height", "0"},
                                      std::pair{"--normal-tolerance", "91"}}) {
    expect_failure(run({"detect", out, "-o", path("x.png"), option, value}), 2, {option, "expected", value});
  }
  const std::vector<std::string> extract{"extract", "c.ply", "--primitives", model, "-o", "x.json"};
  const auto with = [&extract](std::vector<std::string> more) {
    more.insert(more.begin(), extract.begin(), extract.end());
    return more;
  };
  expect_failure(run(with({"--strategy", "magic"})), 2, {"--strategy", "magic", "baseline"});
  expect_failure(run(with({"--seeds", "--no-seeds"})), 2, {"--seeds", "--no-seeds"});
  expect_failure(run(with({"--quiet=loud"})), 2, {"--quiet", "loud", "no value"});
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace cloud2csg::test
