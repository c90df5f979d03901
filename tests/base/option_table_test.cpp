#include "cloud2csg/advanced/option_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cloud2csg {
namespace test {

enum class Colour { red, green };
constexpr auto names_of(Colour /*any*/) {
  return std::to_array<EnumName<Colour>>({{"red", Colour::red}, {"green", Colour::green}});
}

struct InnerOptions {
  double turn_deg = 30;
  std::optional<double> limit_seconds = {};
  std::vector<double> sizes = {1, 2};
};
void option_table(OptionsOf<InnerOptions>, auto&& field) {
  using O = InnerOptions;
  field(&O::turn_deg, "turn_deg", "How far it turns", {.range = above_to(0, 90)});
  field(&O::limit_seconds, "limit_seconds", "When it ends", {.range = above(0), .absent = "never", .option = "end"});
  field(&O::sizes, "sizes", "How large they are", {.range = at_least(0), .option = k_no_option});
}

struct OuterOptions {
  int least = 1, most = 2;
  std::vector<Eigen::Vector3d> axes = {};
  InnerOptions inner = {};
  std::optional<InnerOptions> extra = {};
  std::uint64_t seed = 1;
};
void option_table(OptionsOf<OuterOptions>, auto&& field) {
  using O = OuterOptions;
  field(&O::least, "least", "The least of them", {.range = at_least(0)});
  field(&O::most, "most", "The most of them");
  field(&O::axes, "axes", "Where they lie", {.range = above(0)});
  field(&O::inner, "inner", "What is within");
  field(&O::extra, "extra", "What may be there");
  field(&O::seed, k_seed);
}
std::optional<OptionConflict> conflict_in(const OuterOptions& options) {
  if (options.least <= options.most) return std::nullopt;
  return OptionConflict{"least", "expected no more than `most`"};
}

namespace {

std::string refused(const OuterOptions& options) {
  try {
    validate(options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(OptionTable, FieldsInRangeAreAccepted) {
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.axes = {Eigen::Vector3d::UnitX()}, .inner = {.turn_deg = 90, .limit_seconds = 1e-9}}), "");
}

TEST(OptionTable, OthersAreNamedByTheirPath) {
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused({.least = -1}), "least: expected a whole number of 0 or more, found -1");
  EXPECT_EQ(refused({.axes = {Eigen::Vector3d::Zero()}}), "axes: expected a number above 0, found 0");
  EXPECT_EQ(refused({.inner = {.turn_deg = 0}}), "inner.turn_deg: expected a number above 0 and at most 90, found 0");
  EXPECT_EQ(refused({.inner = {.turn_deg = k_nan}}),
            "inner.turn_deg: expected a number above 0 and at most 90, found nan");
  EXPECT_EQ(refused({.inner = {.limit_seconds = k_infinity}}),
            "inner.limit_seconds: expected a number above 0 and finite, found inf");
  EXPECT_EQ(refused({.inner = {.sizes = {0, -2}}}), "inner.sizes: expected a number of 0 or more, found -2");
  EXPECT_EQ(refused({.extra = InnerOptions{.turn_deg = 91}}).substr(0, 14), "extra.turn_deg");
}

TEST(OptionTable, FieldsThatDoNotGoTogetherAreRefused) {
  EXPECT_EQ(refused({.least = 3}), "least: expected no more than `most`");
}

TEST(OptionTable, RangesInWords) {
  EXPECT_EQ(range_text(at_most(5), true), "a whole number of 5 or less");
  EXPECT_EQ(range_text({}, true), "a whole number");
  EXPECT_EQ(range_text({}, false), "a finite number");
  EXPECT_EQ(range_text(from_to(4, 256), true), "a whole number from 4 to 256");
  const OptionRange with_zero{.least = 16, .most = 4096, .takes_zero = true};
  EXPECT_EQ(range_text(with_zero, true), "0, or a whole number from 16 to 4096");
  EXPECT_TRUE(with_zero.holds(0) && with_zero.holds(16) && !with_zero.holds(15) && !with_zero.holds(-1));
}

TEST(OptionTable, OptionsAreFieldsWithoutUnits) {
  std::vector<std::string> names;
  for_each_field<InnerOptions>([&](auto, const OptionField& field) { names.push_back(option_name(field)); });
  EXPECT_EQ(names, (std::vector<std::string>{"turn", "end", ""}));
}

TEST(OptionTable, ValuesAsTexts) {
  EXPECT_EQ(value_text(0.1), "0.1");
  EXPECT_EQ(value_text(std::optional<int>()), "");
  EXPECT_EQ(value_text(std::vector<Colour>{Colour::red, Colour::green}), "red, green");
  EXPECT_EQ(enum_named<Colour>("green"), Colour::green);
  EXPECT_EQ(enum_named<Colour>("blue"), std::nullopt);
}

}  // namespace
}  // namespace test
}  // namespace cloud2csg
