#include "io/step/step_text.hpp"

#include <gtest/gtest.h>

#include <array>

namespace cloud2csg::brep {
namespace {

TEST(StepString, EscapesWhatTheStandardSays) {
  EXPECT_EQ(step_string("plain (1)"), "'plain (1)'");
  EXPECT_EQ(step_string("it's ('a')"), "'it\\X\\27s (\\X\\27a\\X\\27)'");
  EXPECT_EQ(step_string("a\\b"), "'a\\\\b'");
  EXPECT_EQ(step_string("a\nb\t"), "'a\\X\\0Ab\\X\\09'");
  EXPECT_EQ(step_string("Größe"), "'Gr\\X\\F6\\X\\DFe'");
  EXPECT_EQ(step_string("漢"), "'\\X2\\6F22\\X0\\'");
  EXPECT_EQ(step_string("😀"), "'\\X4\\0001F600\\X0\\'");
  EXPECT_EQ(step_string(""), "''");
}

TEST(StepString, TakesBrokenTextForLatin1) {
  EXPECT_EQ(step_string("\xE9"), "'\\X\\E9'");
  EXPECT_EQ(step_string("\xF0\x9F"), "'\\X\\F0\\X\\9F'");
  EXPECT_EQ(step_string("\xC3("), "'\\X\\C3('");
}

TEST(StepNames, TakeThePlaceOfTheirTokens) {
  const std::array<std::string, 2> names{"it's", "cloud2csg-name-0"};
  const std::string text = "A('" + name_token(0) + "','" + name_token(1) + "','" + name_token(0) + "');";
  EXPECT_EQ(with_names(text, names), R"(A('it\X\27s','cloud2csg-name-0','it\X\27s');)");
}

TEST(StepNames, LeaveAllElseAsItIs) {
  const std::array<std::string, 1> names{"x"};
  for (const char* text : {"'cloud2csg-name-'", "'cloud2csg-name-7'", "cloud2csg-name-0'", "'cloud2csg-name-0", ""}) {
    EXPECT_EQ(with_names(text, names), text);
  }
}

}  // namespace
}  // namespace cloud2csg::brep
