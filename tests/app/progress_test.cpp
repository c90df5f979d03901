#include <gtest/gtest.h>

#include <cstdlib>

#include "session.hpp"

namespace cloud2csg::app {
namespace {

using namespace std::chrono_literals;

/// What a display writes, by a clock that the test sets.
class Shown {
 public:
  explicit Shown(ProgressStyle style)
      : out_(::open_memstream(&text_, &size_)), display_(out_, style, [this] { return now_; }) {}
  ~Shown() {
    display_.finish();
    std::fclose(out_);
    std::free(text_);
  }
  Shown(const Shown&) = delete;
  Shown& operator=(const Shown&) = delete;
  Shown(Shown&&) = delete;
  Shown& operator=(Shown&&) = delete;

  void after(std::chrono::milliseconds time, const Progress& progress) {
    now_ += time;
    display_.update(progress);
  }
  void note(std::string_view line) { display_.note(line); }
  /// Since the last call.
  [[nodiscard]] std::string text() {
    std::fflush(out_);
    std::string all(text_, size_);
    const std::string fresh = all.substr(seen_);
    seen_ = all.size();
    return fresh;
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::size_t seen_ = 0;
  ProgressClock::time_point now_ = {};
  std::FILE* out_;
  ProgressDisplay display_;
};

Progress points(std::size_t done, std::size_t total = 10'000'000) {
  return {.stage = "read", .done = done, .total = total, .unit = "points"};
}

TEST(ProgressDisplay, ALineAStageWithCountsAndRate) {
  Shown shown(ProgressStyle::lines);
  shown.after(0ms, points(0));
  shown.after(1000ms, points(4'000'000));
  EXPECT_EQ(shown.text(), "");
  shown.after(1500ms, points(10'000'000));
  EXPECT_EQ(shown.text(), "read         2.500 s  10000000 points, 4.0 M points/s\n");
}

TEST(ProgressDisplay, AStageThatTheNextOneEndsHasDoneAll) {
  Shown shown(ProgressStyle::lines);
  shown.after(250ms, points(600, 1000));
  shown.after(250ms, {.stage = "search", .done = 0, .total = 1});
  EXPECT_EQ(shown.text(), "read         0.500 s  1000 points, 2.0 k points/s\n");
  shown.after(100ms, {.stage = "search", .done = 1, .total = 1});
  EXPECT_EQ(shown.text(), "search       0.100 s\n");
}

TEST(ProgressDisplay, StepsWithoutAUnitAreNotTold) {
  Shown shown(ProgressStyle::lines);
  shown.after(100ms, {.stage = "mesh", .done = 1, .total = 4});
  shown.after(100ms, {.stage = "mesh", .done = 4, .total = 4});
  EXPECT_EQ(shown.text(), "mesh         0.200 s\n");
}

TEST(ProgressDisplay, WhatHasNoEndIsCounted) {
  Shown shown(ProgressStyle::bar);
  shown.after(2000ms, {.stage = "search", .done = 120, .total = 0, .unit = "generations"});
  EXPECT_EQ(shown.text(), "\r\x1b[Ksearch       120 generations  60 generations/s");
  shown.after(1000ms, {.stage = "search", .done = 1, .total = 1});
  EXPECT_EQ(shown.text(), "\r\x1b[Ksearch       3.000 s  120 generations, 40 generations/s\n");
}

TEST(ProgressDisplay, TheBarTellsRateAndTimeLeft) {
  Shown shown(ProgressStyle::bar);
  shown.after(500ms, points(1'000'000));
  // Too early for a forecast.
  EXPECT_EQ(shown.text(), "\r\x1b[Kread         [###...........................]  10 %  2.0 M points/s");
  shown.after(1500ms, points(4'000'000));
  EXPECT_EQ(shown.text(), "\r\x1b[Kread         [############..................]  40 %  2.0 M points/s  3 s left");
  // Too soon after that to be drawn.
  shown.after(10ms, points(4'100'000));
  EXPECT_EQ(shown.text(), "");
}

TEST(ProgressDisplay, LongTimesAreMinutesAndHours) {
  Shown shown(ProgressStyle::bar);
  shown.after(60'000ms, {.stage = "M0", .done = 1, .total = 3, .unit = "runs"});
  EXPECT_NE(shown.text().find("  2 min 0 s left"), std::string::npos);
  shown.after(3'600'000ms, {.stage = "M0", .done = 1, .total = 3, .unit = "runs"});
  EXPECT_NE(shown.text().find("  2 h 2 min left"), std::string::npos);
}

TEST(ProgressDisplay, TimeIsCountedFromTheStageBefore) {
  Shown shown(ProgressStyle::lines);
  shown.after(400ms, points(1000, 1000));
  shown.after(600ms, {.stage = "overlap", .done = 18, .total = 18, .unit = "primitives"});
  EXPECT_EQ(
      shown.text(),
      "read         0.400 s  1000 points, 2.5 k points/s\noverlap      0.600 s  18 primitives, 30 primitives/s\n");
}

TEST(ProgressDisplay, OnlyTheColouredBarHasColours) {
  for (const auto& [style, is_coloured] :
       {std::pair{ProgressStyle::color_bar, true}, {ProgressStyle::bar, false}, {ProgressStyle::lines, false}}) {
    Shown shown(style);
    shown.after(500ms, points(5'000'000));
    shown.after(500ms, points(10'000'000));
    shown.note("done");
    EXPECT_EQ(shown.text().find("\x1b[32m") != std::string::npos, is_coloured);
  }
}

TEST(ProgressDisplay, QuietIsSilent) {
  Shown shown(ProgressStyle::none);
  shown.after(500ms, points(10'000'000));
  shown.note("done");
  EXPECT_EQ(shown.text(), "");
}

}  // namespace
}  // namespace cloud2csg::app
