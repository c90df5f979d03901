#include "bench/experiment/table.hpp"

#include <gtest/gtest.h>

namespace cloud2csg {
namespace {

Table example() {
  return {.name = "example",
          .title = "An example",
          .note = "Made up.",
          .columns = {"model", "points", "time"},
          .rows = {{std::string("m0, \"old\""), 1200.0, Spread{.count = 3, .mean = 12.3456, .deviation = 0.0567}},
                   {std::string("m1"), 1.5, Spread{.count = 1, .mean = 7, .deviation = 0}},
                   {std::string("m2"), 0.0, Spread{}}}};
}

TEST(Table, AsMarkdown) {
  EXPECT_EQ(to_markdown(example()),
            "## An example\n"
            "Made up.\n"
            "\n"
            "| model     | points | time           |\n"
            "|-----------|--------|----------------|\n"
            "| m0, \"old\" |   1200 | 12.346 ± 0.057 |\n"
            "| m1        |  1.500 |          7 ± ? |\n"
            "| m2        |      0 |              - |\n");
}

TEST(Table, AsCsv) {
  EXPECT_EQ(to_csv(example()),
            "model,points,time,time sd\n"
            "\"m0, \"\"old\"\"\",1200,12.3456,0.0567\n"
            "m1,1.5,7,\n"
            "m2,0,,\n");
}

TEST(Table, NumbersKeepFourDigitsAndHaveNoExponent) {
  EXPECT_EQ(to_text(TableCell(0.00123456)), "0.001235");
  EXPECT_EQ(to_text(TableCell(123456.7)), "123457");
  EXPECT_EQ(to_text(TableCell(1e7)), "10000000");
  EXPECT_EQ(to_text(TableCell(-2.5)), "-2.500");
}

TEST(Table, WholeMeansShowTheirDeviation) {
  EXPECT_EQ(to_text(TableCell(Spread{.count = 2, .mean = 38.5, .deviation = 1e-7})), "38.5000 ± 0.0000");
  EXPECT_EQ(to_text(TableCell(Spread{.count = 2, .mean = 38, .deviation = 1.41421356})), "38.0 ± 1.4");
}

}  // namespace
}  // namespace cloud2csg
