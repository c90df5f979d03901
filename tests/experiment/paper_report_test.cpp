#include <sys/stat.h>

#include <cstdlib>

#include "bench/experiment/gnuplot.hpp"
#include "bench/experiment/paper_tables.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "experiment/experiment_fixture.hpp"

namespace cloud2csg::test {
namespace {

/// The search path of programs, while it lives.
class SearchPath {
 public:
  explicit SearchPath(const std::string& path) {
    if (const char* before = std::getenv("PATH")) before_ = before;
    ::setenv("PATH", path.c_str(), 1);
  }
  ~SearchPath() { ::setenv("PATH", before_.c_str(), 1); }
  SearchPath(const SearchPath&) = delete;
  SearchPath& operator=(const SearchPath&) = delete;
  SearchPath(SearchPath&&) = delete;
  SearchPath& operator=(SearchPath&&) = delete;

 private:
  std::string before_;
};

class PaperReport : public ExperimentTest {
 protected:
  /// A program of this name that is found first.
  void make_program(const std::string& name, const std::string& script) const {
    write_text_file(folder() / name, "#!/bin/sh\n" + script);
    ::chmod((folder() / name).c_str(), 0755);
  }
  [[nodiscard]] std::string text_of(const std::string& file) const { return read_text_file(folder() / file); }
  [[nodiscard]] bool has(const std::string& file) const { return std::filesystem::exists(folder() / file); }
};

/// Results of two repeats of one model, made up so that summaries can be done by hand.
PaperResults made_up() {
  PaperResults results{.options = {.models = {"m"}, .low_points = 100, .high_points = 1000, .repeats = 2},
                       .environment = {.version = "1.2.3", .compiler = "g++ 12", .cpu = "Some CPU", .cores = 2},
                       .models = {{.name = "m", .primitives = 3, .tree = {.size = 5, .leaves = 3, .depth = 2}}}};
  for (const RunName& name : plan_runs(results.options)) {
    const bool is_baseline = paper_mode(name.mode).strategy == Strategy::baseline;
    PaperRun run{.name = name, .finished = "2020-01-02T03:04:05Z", .clique_histogram = {0, 0, 1}, .formula = "a | b"};
    // Baseline 40 and 60 ms, partitioned 10 and 10; twice as much for high sampling.
    run.seconds.extraction =
        (is_baseline ? (name.seed == 1 ? 0.04 : 0.06) : 0.01) * (name.sampling == Sampling::low ? 1 : 2);
    run.seconds.search = run.seconds.extraction / 4;
    run.tree = {.size = is_baseline ? 4U : 6U, .leaves = 3, .depth = 2};
    results.runs.push_back(run);
  }
  return results;
}

TEST_F(PaperReport, TablesSummarise) {
  const std::vector<Table> tables = paper_tables(made_up());
  const auto row = [&tables](const std::string& table, std::size_t index) {
    std::vector<std::string> texts;
    for (const TableCell& cell : table_of(tables, table).rows.at(index)) texts.push_back(to_text(cell));
    return texts;
  };
  using Row = std::vector<std::string>;
  EXPECT_EQ(row("models", 0), (Row{"m", "3", "5", "2", "100", "1000", "(0, 0, 1)"}));
  EXPECT_EQ(row("durations", 0), (Row{"m", "low", "50 ± 14", "50 ± 14", "10 ± 0", "10 ± 0", "10 ± 0", "10 ± 0"}));
  EXPECT_EQ(row("durations", 1)[4], "20 ± 0");
  EXPECT_EQ(row("speed_up", 0)[2], "5.0 ± 1.4");
  EXPECT_EQ(row("speed_up_search", 0)[2], "5.0 ± 1.4");
  EXPECT_EQ(row("growth", 0)[3], "5 ± 0");  // ten times the points in twice the time
  EXPECT_EQ(row("trees", 0), (Row{"m", "low", "5", "4 ± 0", "6 ± 0", "20 ± 0", "50 ± 0", "2", "2 ± 0", "2 ± 0"}));
  EXPECT_EQ(row("steps", 1)[7], "25 ± 0");
}

TEST_F(PaperReport, WritesTablesAndTheirSetting) {
  (void)write_paper_report(folder(), made_up());
  const std::string text = text_of("paper.md");
  for (const char* part : {"cloud2csg 1.2.3", "Some CPU, 2 cores", "2020-01-02T03:04:05Z", "seeds 1 to 2",
                           "the same tree", "in all 24 runs", "| BST ", "50 ± 14"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(text_of("durations.csv").substr(0, 38), "model,sampling,BST,BST sd,BMTGA,BMTGA ");
  for (const char* file : {"models.csv", "growth.csv", "trees.csv", "steps.csv", "runs.csv", "speed_up.csv"}) {
    EXPECT_TRUE(has(file)) << file;
  }
}

TEST_F(PaperReport, DifferentTreesAreSaid) {
  PaperResults results = made_up();
  results.runs[1].formula = "a";
  (void)write_paper_report(folder(), results);
  EXPECT_NE(text_of("paper.md").find("- m low, seed 1: BST and BMTGA"), std::string::npos);
}

TEST_F(PaperReport, WithoutGnuplotTheRestIsWritten) {
  const SearchPath none(folder().string());
  const std::vector<std::string> notes = write_paper_report(folder(), made_up());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("gnuplot is not installed"), std::string::npos);
  EXPECT_TRUE(has("paper.md"));
  EXPECT_TRUE(has("durations_low.gp"));
  EXPECT_FALSE(has("durations_low.svg"));
  EXPECT_EQ(text_of("paper.md").find(".svg"), std::string::npos);
}

TEST_F(PaperReport, GnuplotDrawsEveryFigure) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  EXPECT_EQ(write_paper_report(folder(), made_up()), std::vector<std::string>{});
  for (const char* name : {"durations_low", "durations_high", "tree_sizes", "steps"}) {
    const std::string picture = text_of(std::string(name) + ".svg");
    EXPECT_EQ(picture.substr(0, 5), "<?xml") << name;
    EXPECT_NE(picture.find("</svg>"), std::string::npos) << name;
    EXPECT_NE(text_of("paper.md").find(std::string(name) + ".svg"), std::string::npos) << name;
  }
}

TEST_F(PaperReport, FailureOfGnuplotIsPassedOn) {
  make_program("gnuplot", "echo; echo 'line 3: no such thing' >&2; exit 1\n");
  const SearchPath first(folder().string());
  try {
    (void)write_paper_report(folder(), made_up());
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("durations_low.gp: gnuplot failed: line 3: no such thing"),
              std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(has("durations_low.svg"));
}

}  // namespace
}  // namespace cloud2csg::test
