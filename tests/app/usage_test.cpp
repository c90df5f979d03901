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
  for (const char* command : {"extract", "sample", "compare", "convert", "info"}) {
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

TEST_F(Usage, ValuesAreChecked) {
  const std::string model = shipped("m1.json");
  const std::string out = path("x.ply");
  expect_failure(run({"sample", model}), 2, {"--output"});
  expect_failure(run({"sample", "-o", out}), 2, {"model"});
  expect_failure(run({"sample", model, "-o"}), 2, {"--output"});
  expect_failure(run({"sample", model, "-o", out, "-n", "0"}), 2, {"--count"});
  expect_failure(run({"sample", model, "-o", out, "-n", "many"}), 2, {"--count", "many"});
  expect_failure(run({"sample", model, "-o", out, "--noise", "-0.1"}), 2, {"--noise", "-0.1"});
  expect_failure(run({"sample", model, "-o", out, "--noise", "nan"}), 2, {"--noise", "nan"});
  expect_failure(run({"sample", model, "-o", out, "extra"}), 2, {"extra"});
  expect_failure(run({"extract", "c.ply", "--primitives", model, "-o", "x.json", "--strategy", "magic"}), 2,
                 {"--strategy", "magic", "baseline"});
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace cloud2csg::test
