#include <algorithm>
#include <cstdlib>

#include "app/program.hpp"
#include "installation.hpp"

namespace cloud2csg::test {
namespace {

class Habits : public ProgramTest {
 protected:
  /// What a shell says to a script that may use $1, $2...
  [[nodiscard]] std::string said_by(const std::string& shell, const std::string& script) {
    const std::string to = path("said");
    const std::string command = shell + " " + file("script", script) + " >" + to + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << read_file(to);
    return read_file(to);
  }
  static bool is_there(const std::string& program) {
    const char* const search_path = std::getenv("PATH");
    return search_path != nullptr && app::find_program(program, search_path).has_value();
  }
  [[nodiscard]] std::string completion(const std::string& shell) {
    return file("completion." + shell, run({"completion", shell}).out);
  }
  /// Goes to the test's folder and loads the completion, which asks the program.
  [[nodiscard]] std::string begin_of_script(const std::string& shell) {
    const std::string folder_of_program = std::filesystem::path(CLOUD2CSG_PROGRAM).parent_path().string();
    return "export PATH=\"" + folder_of_program + ":$PATH\"; cd " + folder().string() + "; source " +
           completion(shell) + "\n";
  }
  /// What bash offers for the last of these words, sorted, one a line.
  [[nodiscard]] std::string offered(const std::string& words) {
    return said_by("bash", begin_of_script("bash") + "COMP_WORDS=(" + words +
                               ")\nCOMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 ))\n_cloud2csg\n"
                               "printf '%s\\n' \"${COMPREPLY[@]}\" | sort\n");
  }
};

TEST_F(Habits, VersionTellsFeatures) {
  const std::string text = run({"--version"}).out;
  for (const char* feature : {"step", "brep", "html", "view"}) {
    EXPECT_TRUE(text.find(std::string("+") + feature) != std::string::npos ||
                text.find(std::string("-") + feature) != std::string::npos)
        << text;
  }
}

TEST_F(Habits, HelpIsACommand) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  const Outcome help = run({"help", "extract"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.out, run({"extract", "--help"}).out);
  const Outcome bench = run({"bench"});
  EXPECT_EQ(bench.status, 2);
  EXPECT_EQ(bench.err, run({"bench", "--help"}).out);
}

TEST_F(Habits, AReaderThatWentAwayEndsItQuietly) {
  // A pipe that nobody reads, whatever its size.
  for (const char* words : {"completion bash", "--help", "info --json M", "help extract"}) {
    const std::string line = std::string(words);
    const std::string with_model = line.ends_with('M') ? line.substr(0, line.size() - 1) + shipped("m1.json") : line;
    const std::string script = "{ sleep 0.3; " CLOUD2CSG_PROGRAM " " + with_model + "; echo $? >" + path("status") +
                               "; } 2>" + path("err") + " | true";
    EXPECT_EQ(said_by("sh", script), "");
    EXPECT_EQ(read_file(path("status")), "141\n") << words;
    EXPECT_EQ(read_file(path("err")).find("cloud2csg:"), std::string::npos) << read_file(path("err"));
  }
}

TEST_F(Habits, DoctorLooksAtEachPart) {
  const Outcome outcome = run({"doctor"});
  EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  for (const char* part :
       {"cloud2csg", "processor", "CAD files", "reports", "models", "OpenSCAD", "gnuplot", "browser"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part;
  EXPECT_NE(outcome.out.find("instruction set "), std::string::npos);
  const bool has_step = run({"--version"}).out.find("+step") != std::string::npos;
  EXPECT_EQ(outcome.out.find("ok      CAD files") != std::string::npos, has_step) << outcome.out;
}

TEST_F(Habits, DoctorFindsProgramsByThePath) {
  const Outcome none = run({"doctor"}, "PATH=" + folder().string() + "; export PATH");
  EXPECT_EQ(none.status, 0);
  EXPECT_NE(none.out.find("absent  OpenSCAD   'openscad' is not found"), std::string::npos) << none.out;
  // Not one that cannot be run.
  (void)file("openscad", "");
  const std::string path_setup = "PATH=/nowhere:" + folder().string() + "; export PATH";
  EXPECT_NE(run({"doctor"}, path_setup).out.find("absent  OpenSCAD"), std::string::npos);
  std::filesystem::permissions(path("openscad"), std::filesystem::perms::owner_all);
  EXPECT_NE(run({"doctor"}, path_setup).out.find("ok      OpenSCAD   " + path("openscad")), std::string::npos);
}

TEST_F(Habits, DoctorFailsForABrokenPart) {
  if (run({"--version"}).out.find("+step") == std::string::npos) GTEST_SKIP() << "built without OpenCASCADE";
  // A copy of the program that takes an empty file for its module.
  (void)file("libcloud2csg_opencascade.so", "");
  const Outcome outcome = run({"doctor"}, "LD_LIBRARY_PATH=" + folder().string() + "; export LD_LIBRARY_PATH");
  if (outcome.status == 0) GTEST_SKIP() << "the run path comes first here";
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("BROKEN  CAD files"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("install cloud2csg again"), std::string::npos) << outcome.err;
}

TEST_F(Habits, BashCompletesCommandsOptionsAndValues) {
  EXPECT_EQ(offered("cloud2csg ex"), "extract\n");
  EXPECT_EQ(offered("cloud2csg bench ''"), "compare\npaper\nscaling\n");
  EXPECT_EQ(offered("cloud2csg extract x.ply --se"), "--seed\n--seeds\n");
  EXPECT_EQ(offered("cloud2csg extract --strategy ''"), "auto\nbaseline\ncells\npartition\n");
  EXPECT_EQ(offered("cloud2csg extract --strategy = ce"), "cells\n");
  EXPECT_EQ(offered("cloud2csg extract --strategy ="), "auto\nbaseline\ncells\npartition\n");
  EXPECT_EQ(offered("cloud2csg completion ''"), "bash\nfish\nzsh\n");
  // The options of the command that is meant, not of another.
  EXPECT_EQ(offered("cloud2csg info --str"), "\n");
}

TEST_F(Habits, BashCompletesFilesByTheirEndings) {
  for (const char* name : {"part.ply", "part.json", "part.scad", "part.PCD", "part.pdf", "two words.stl"})
    (void)file(name, "");
  std::filesystem::create_directory(path("parts"));
  EXPECT_EQ(offered("cloud2csg extract part"), "part.PCD\npart.ply\nparts\n");
  EXPECT_EQ(offered("cloud2csg extract two"), "two words.stl\n");
  EXPECT_EQ(offered("cloud2csg extract part.ply --primitives pa"), "part.json\npart.scad\nparts\n");
  EXPECT_EQ(offered("cloud2csg convert part.json -o part."), "part.json\npart.scad\n");
}

TEST_F(Habits, CompletionsAreReadByTheirShells) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    if (!is_there(shell)) continue;
    EXPECT_EQ(said_by(shell + " -n", read_file(completion(shell))), "");
  }
}

TEST_F(Habits, CompletionTellsWhatWordsMean) {
  const auto told = [this](std::vector<std::string> words) {
    words.insert(words.begin(), "complete");
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  };
  EXPECT_EQ(told({"doc"}), "doctor\tReports which optional parts are installed, and what is broken\n");
  EXPECT_EQ(told({"help", "doc"}), told({"doc"}));
  EXPECT_EQ(told({"info", "x.ply", "--js"}), "--json\tPrint JSON instead of a table\n");
  // Once given, only what may be repeated is offered again.
  EXPECT_EQ(told({"info", "--json", "x.ply", "--js"}), "");
  EXPECT_EQ(told({"sample", "-o", "a.ply", "--outp"}).substr(0, 9), "--output\t");
  // A word that has a value in it keeps what is before the value.
  EXPECT_EQ(told({"extract", "--strategy=ce"}), "--strategy=cells\n");
  EXPECT_EQ(told({"extract", "--primitives=p"}), ":files:--primitives=:.json .scad .csg\n");
  EXPECT_EQ(told({"convert", "a.json", "-op"}).substr(0, 16), ":files:-o:.json ");
  // As many arguments as the command takes.
  EXPECT_EQ(told({"info", ""}), ":files::\n");
  EXPECT_EQ(told({"compare", "a", ""}).substr(0, 13), ":files::.ply ");
  EXPECT_EQ(told({"compare", "a", "b", ""}), "");
  EXPECT_EQ(told({"extract", "--seed", ""}), "");
  // An option may take several words; the next option ends them.
  EXPECT_EQ(told({"bench", "scaling", "--family", "chain", "g"}), "grid\n");
  EXPECT_EQ(told({"bench", "scaling", "--family", "chain", "--cl"}).substr(0, 10), "--cliques\t");
  EXPECT_EQ(told({"manu"}), "");  // hidden
  EXPECT_EQ(told({"--"}).find("--leaf-cost"), std::string::npos);
  EXPECT_EQ(told({}), "");
}

TEST_F(Habits, ZshCompletes) {
  if (!is_there("zsh")) GTEST_SKIP() << "no zsh here";
  // What the completion calls, which works at a prompt only.
  const std::string begin =
      "compdef() {}; compset() { print -r before $2 }; _files() { print -r files $* }; _describe() { print -rl "
      "${(P)2} }\n" +
      begin_of_script("zsh");
  const auto offers = [&](const std::string& words, const std::string& start) {
    return said_by("zsh -f", begin + "words=(cloud2csg " + words + "'" + start + "'); CURRENT=$#words; PREFIX='" +
                                 start + "'; _cloud2csg\n");
  };
  EXPECT_EQ(offers("", "conv"), "convert:Writes a model in other formats\n");
  EXPECT_EQ(offers("bench ", "pa"),
            "paper:Repeats the paper's evaluation of its models and modes, with tables and figures\n");
  EXPECT_EQ(offers("extract --strategy ", "p"), "partition\n");
  EXPECT_EQ(offers("extract a\\ b.ply --primitives ", "pa"), "before\nfiles -g *.(#i)(json|scad|csg)\n");
  EXPECT_EQ(offers("extract a.ply ", "--primitives=pa"), "before --primitives=\nfiles -g *.(#i)(json|scad|csg)\n");
  EXPECT_EQ(offers("info ", ""), "before\nfiles\n");
}

TEST_F(Habits, FishCompletes) {
  if (!is_there("fish")) GTEST_SKIP() << "no fish here";
  (void)file("part.ply", "");
  (void)file("part.pdf", "");
  const std::string begin = begin_of_script("fish");
  const auto offers = [&](const std::string& line) {
    return said_by("fish --no-config", begin + "complete -C '" + line + "' | string split -f1 \\t | sort\n");
  };
  EXPECT_EQ(offers("cloud2csg ex"), "extract\n");
  EXPECT_EQ(offers("cloud2csg extract --strategy "), "auto\nbaseline\ncells\npartition\n");
  EXPECT_EQ(offers("cloud2csg extract par"), "part.ply\n");
  EXPECT_EQ(offers("cloud2csg extract --unexplained=par"), "--unexplained=part.ply\n");
  EXPECT_EQ(offers("cloud2csg bench paper --see"), "--seed\n");
}

TEST_F(Habits, ManualPagesAreWellFormed) {
  const std::filesystem::path pages = folder() / "pages";
  std::filesystem::create_directory(pages);
  ASSERT_EQ(run({"manual", pages.string()}).status, 0);
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(pages)) {
    ++count;
    const std::string page = read_file(entry.path());
    EXPECT_NE(page.find(".SH NAME"), std::string::npos) << entry.path();
    if (is_there("groff")) {
      EXPECT_EQ(said_by("sh", "groff -man -ww -z " + entry.path().string() + "\n"), "") << entry.path();
    }
  }
  EXPECT_GE(count, 12U);
  const std::string extract = read_file(pages / "cloud2csg-extract.1");
  EXPECT_NE(extract.find("\\fB\\-\\-leaf\\-cost\\fR \\fISHARE\\fR"), std::string::npos);
  EXPECT_NE(extract.find(".SS Genetic algorithm"), std::string::npos);
  EXPECT_EQ(extract.find("manual"), std::string::npos);  // hidden
}

}  // namespace
}  // namespace cloud2csg::test
