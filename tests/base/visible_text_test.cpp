#include <gtest/gtest.h>

#include "cloud2csg/error.hpp"
#include "core/base/text.hpp"

namespace cloud2csg {
namespace {

TEST(VisibleText, LeavesLettersAlone) {
  for (const char* text : {"", "box_1", "Gehäuse ⌀5", "箱", "a\\b", "\U0001F529"}) EXPECT_EQ(visible_text(text), text);
}

TEST(VisibleText, EscapesWhatATerminalObeys) {
  EXPECT_EQ(visible_text("a\x1b[31mb"), "a\\x1b[31mb");
  EXPECT_EQ(visible_text("a\nb\tc\rd\x7f"), "a\\x0ab\\x09c\\x0dd\\x7f");
  EXPECT_EQ(visible_text("\xC2\x9B"), "\\x9b");  // C1
  EXPECT_EQ(visible_text("a\xE2\x80\xAE"
                         "b"),
            "a\\u202eb");  // turns the direction of reading
  EXPECT_EQ(visible_text("\xE2\x81\xA6\xE2\x80\x8F"), "\\u2066\\u200f");
  EXPECT_EQ(visible_text("a\xFF\xC3"), "a\\xff\\xc3");  // no UTF-8
}

TEST(VisibleText, CutsLongOnesBetweenCharacters) {
  EXPECT_EQ(visible_text("abcd", 4), "abcd");
  EXPECT_EQ(visible_text("abcde", 4), "abcd...");
  EXPECT_EQ(visible_text("a\x1b\x1b", 6), "a\\x1b...");
  EXPECT_EQ(visible_text("ab⌀c", 4), "ab...");
}

TEST(VisibleText, TwiceIsOnce) {
  const std::string once = visible_text("a\x1b\n\xFF");
  EXPECT_EQ(visible_text(once), once);
}

TEST(VisibleText, ErrorsAreOneLine) {
  const Error error({.file = "a\nb", .where = "/x\x1b[2J", .expected = "no"});
  EXPECT_STREQ(error.what(), "a\\x0ab: /x\\x1b[2J: no");
  EXPECT_EQ(error.parts().file, "a\nb");
}

}  // namespace
}  // namespace cloud2csg
