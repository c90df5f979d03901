#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/view.hpp"
#include "core/base/files.hpp"
#include "support/outside_program.hpp"

/// Names in a model are somebody else's text: in whatever is written of it, they stay names.
namespace cloud2csg {
namespace {

/// In each, the word that must not be outside of a string or a comment.
const std::vector<std::string>& names() {
  static const std::vector<std::string> all{R"("); import os; os.system("touch PWNED") #)",
                                            R"(""" + open("PWNED", "w").name + """)",
                                            R"('); PWNED('')",
                                            R"(*/ echo("PWNED"); /*)",
                                            "line\nopen('PWNED', 'w')\r\nimport PWNED\n#",
                                            "$(touch PWNED) `touch PWNED` ; touch PWNED",
                                            R"html(</script><script>PWNED()</script><img src=x onerror="PWNED()">)html",
                                            R"(ends with a backslash \)",
                                            R"(\" ; PWNED ; \\")",
                                            R"(\N{BULLET} \x41 \u0041 %s {} {0} {{PWNED}})",
                                            R"('';ENDSEC;DATA;#1=PWNED();)",
                                            "caf\xc3\xa9 \xe6\xbc\xa2 \xf0\x9f\x98\x80",
                                            "\xe2\x80\xae PWNED \xe2\x80\xa8 PWNED",
                                            "import",
                                            "part",
                                            "cq",
                                            "FreeCAD",
                                            "union",
                                            "__import__",
                                            "everything",
                                            "box",
                                            "\x01\x0b\x0c\x1b[31m PWNED"};
  return all;
}

Model hostile_model() {
  Model model;
  model.description = "*/ PWNED(); \"\"\"\nopen('PWNED', 'w')\r</script><script>PWNED()</script>";
  CsgTree tree = CsgTree::empty();
  for (std::size_t i = 0; i < names().size(); ++i) {
    const double x = 3.0 * static_cast<double>(i * i);
    const auto kind = i % 3;
    model.primitives.push_back({.id = names()[i],
                                .shape = kind == 0   ? Shape(Box{.size = {1, 2, 1}})
                                         : kind == 1 ? Shape(Sphere{.radius = 1})
                                                     : Shape(Cylinder{.radius = 1, .height = 2}),
                                .pose = {.position = {x, 0, 0}}});
    const CsgTree leaf = CsgTree::leaf(static_cast<PrimitiveIndex>(i));
    tree = i == 0 ? leaf : unite(tree, leaf);
  }
  model.tree = tree;
  return model;
}

class Injection : public testing::Test {
 protected:
  std::string written(const std::string& name) {
    export_model(folder_.file(name), model_);
    return test::content_of(folder_.file(name));
  }

  void TearDown() override { EXPECT_FALSE(std::filesystem::exists(folder_.file("PWNED"))) << "a name was run"; }

  test::ScratchFolder folder_;
  Model model_ = hostile_model();
};

/// What is left of a text without its quoted strings and its comments to the end of a line; `escape` may be none.
std::string code_of(const std::string& text, char quote, char escape, const std::string& comment) {
  std::string code;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_quoted && text[i] == escape && escape != '\0') {
      ++i;
    } else if (text[i] == quote) {
      is_quoted = !is_quoted;
    } else if (!is_quoted && !comment.empty() && text.compare(i, comment.size(), comment) == 0) {
      while (i + 1 < text.size() && text[i + 1] != '\n' && text[i + 1] != '\r') ++i;
    } else if (!is_quoted) {
      code += text[i];
    }
  }
  EXPECT_FALSE(is_quoted) << "a string has no end";
  return code;
}

void expect_ascii(const std::string& code) {
  EXPECT_TRUE(std::all_of(code.begin(), code.end(), [](unsigned char c) { return c == '\n' || (c >= 32 && c < 127); }))
      << code;
}

void expect_clean(const std::string& code) {
  EXPECT_EQ(code.find("PWNED"), std::string::npos) << code;
  expect_ascii(code);
}

TEST_F(Injection, OpenScad) {
  for (const char* file : {"part.scad", "part.csg"}) {
    // Names are part of identifiers here; that they are no more than that, OpenSCAD says.
    expect_ascii(code_of(written(file), '"', '\\', "//"));
    if (!test::has_program("openscad")) continue;
    const test::Run run = test::run_in(folder_, std::string("timeout 300 openscad -o tree.csg ") + file);
    EXPECT_EQ(run.status, 0) << run.output;
    for (const char* word : {"WARNING", "ERROR", "ECHO", "PWNED"}) {
      EXPECT_EQ(run.output.find(word), std::string::npos) << run.output;
    }
    const std::string tree = test::content_of(folder_.file("tree.csg"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(tree.begin(), tree.end(), ';')), names().size()) << "the solids";
  }
}

TEST_F(Injection, Python) {
  write_text_file(folder_.file("points"), "0 0 0\n0 0 1.5\n");
  for (const char* file : {"part.py", "part.FCMacro"}) {
    const std::string text = written(file);
    EXPECT_EQ(text.find('\r'), std::string::npos);
    const test::Run run = test::judge(folder_, file, "points");
    ASSERT_EQ(run.status, 0) << run.output << text;
    const std::size_t line = run.output.find('\n');
    EXPECT_EQ(run.output.substr(0, line), "10") << file;
    if (std::string(file) == "part.py") continue;
    // FreeCAD shows the names as they are.
    const auto labels = nlohmann::json::parse(run.output.substr(line));
    for (std::size_t i = 0; i < names().size(); ++i) EXPECT_EQ(labels.at(i), names()[i]);
  }
}

TEST_F(Injection, Graphviz) {
  expect_clean(code_of(written("part.dot"), '"', '\\', ""));
}

TEST_F(Injection, Json) {
  const Model read = parse_model(written("part.json"));
  EXPECT_EQ(read.description, model_.description);
  ASSERT_EQ(read.primitives.size(), names().size());
  for (std::size_t i = 0; i < names().size(); ++i) EXPECT_EQ(read.primitives[i].id, names()[i]);
}

TEST_F(Injection, Step) {
  if (!has_brep()) GTEST_SKIP() << "needs OpenCASCADE";
  export_model(folder_.file("part.step"), model_, {.brep = {.name = names().front(), .with_primitives = true}});
  expect_clean(code_of(test::content_of(folder_.file("part.step")), '\'', '\0', ""));
}

TEST_F(Injection, Report) {
  const Report report{.title = names()[6],
                      .source = names()[3],
                      .model = model_,
                      .downloads = {{names()[6], written("part.scad")}},
                      .warnings = names()};
  write_report(folder_.file("report.html"), report);
  const std::string page = test::content_of(folder_.file("report.html"));
  EXPECT_EQ(page.find("PWNED()"), std::string::npos);
  EXPECT_EQ(page.find("<img src=x"), std::string::npos);
  Model harmless = model_;
  for (std::size_t i = 0; i < names().size(); ++i) harmless.primitives[i].id = "p" + std::to_string(i);
  write_report(folder_.file("harmless.html"), {.title = "t", .model = harmless});
  const auto tags = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("<script"); at != std::string::npos; at = text.find("<script", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(tags(page), tags(test::content_of(folder_.file("harmless.html"))));
}

}  // namespace
}  // namespace cloud2csg
