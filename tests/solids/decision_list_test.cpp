#include "raw/solids/decision_list.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cloud2csg/sample.hpp"
#include "raw/solids/write_solids.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr TermCosts k_costs{};

/// A term space over a part of boxes, a cylinder and a sphere, and the places it was made from.
struct Scene {
  LabelledPlaces places;
  TermSpace space;
};

const Scene& scene() {
  static const Scene made = [] {
    const PrimitiveSet solids{
        test::placed("a", Box{{4, 3, 1}}, {0, 0, 0}), test::placed("b", Box{{1, 1, 2}}, {1, 0, 1}),
        test::placed("c", Cylinder{0.5, 3}, {-1, 0, 0}), test::placed("d", Sphere{0.6}, {-0.6, 0.3, 0.4})};
    const CsgTree tree = parse_tree("((a | b) - c) | d", solids);
    const PointCloud cloud = sample_surface({.primitives = solids, .tree = tree}, {.count = 3000, .seed = 2});
    Scene result;
    result.places = label_places(cloud, {.noise = 0.0, .volume_places = 3000, .surface_points = 1000});
    result.space = make_term_space(cloud, test::known_surfaces(solids, cloud, 0.01), result.places, 0.01);
    return result;
  }();
  return made;
}

BinRange any_range(std::uint32_t bins) {
  const std::uint32_t first = *rc::gen::inRange(0U, bins);
  return {first, *rc::gen::inRange(first, bins)};
}

TermPart any_part(PartKind kind) {
  const TermSpace& space = scene().space;
  TermPart part;
  part.kind = kind;
  if (part.kind == PartKind::box) {
    for (std::size_t axis = 0; axis < 3; ++axis) part.ranges[axis] = any_range(space.boxes[0].bins[axis].count());
  } else {
    part.family = *rc::gen::inRange(0U, static_cast<std::uint32_t>(space.revolved.size()));
    part.ranges[0] = any_range(space.revolved[part.family].bins.count());
  }
  return part;
}

PartKind any_kind() {
  return *rc::gen::element(PartKind::box, PartKind::revolved);
}

/// A box, a curved solid, or what one of them has in common with the inside or outside of another.
Rule any_rule() {
  const PartKind first = any_kind();
  Rule rule{.term = {.parts = {any_part(first)}}, .members = {}, .is_in = *rc::gen::arbitrary<bool>()};
  if (*rc::gen::arbitrary<bool>()) {
    TermPart second = any_part(first == PartKind::box ? PartKind::revolved : any_kind());
    second.is_inverted = *rc::gen::arbitrary<bool>();
    rule.term.parts.push_back(second);
  }
  rule.members = members_of(scene().space, rule.term);
  return rule;
}

DecisionList any_list() {
  DecisionList list;
  const std::size_t rules = *rc::gen::inRange<std::size_t>(1, 7);
  for (std::size_t r = 0; r < rules; ++r) list.push_back(any_rule());
  return list;
}

std::vector<double> any_gains() {
  std::vector<double> gains(scene().space.size());
  for (double& gain : gains) gain = *rc::gen::inRange(-8, 6) / 64.0;
  return gains;
}

RC_GTEST_PROP(DecisionList, RemovalSavesWhatTheCostsDifferBy, ()) {
  const DecisionList list = any_list();
  const std::vector<double> savings = removal_savings(list, scene().space.pulls, k_costs);
  const double cost = cost_of(list, scene().space.pulls, k_costs);
  for (std::size_t r = 0; r < list.size(); ++r) {
    DecisionList shorter = list;
    shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(r));
    RC_ASSERT(std::abs(cost - savings[r] - cost_of(shorter, scene().space.pulls, k_costs)) < 1e-9);
  }
}

RC_GTEST_PROP(DecisionList, InsertionGainsWhatTheCostsDifferBy, ()) {
  const DecisionList list = any_list();
  const TermSpace& space = scene().space;
  const Rule rule = any_rule();
  const std::size_t position = *rc::gen::inRange<std::size_t>(0, list.size() + 1);
  const std::vector<double> gains =
      insertion_gains(list, deciding_rules(list, space.size()), space.pulls, position, rule.is_in);
  double gain = -cost_of(rule.term, k_costs);
  for (std::size_t i = 0; i < gains.size(); ++i) gain += rule.members[i] != 0 ? gains[i] : 0.0;
  DecisionList longer = list;
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(position), rule);
  RC_ASSERT(std::abs(cost_of(list, space.pulls, k_costs) - gain - cost_of(longer, space.pulls, k_costs)) < 1e-9);
}

RC_GTEST_PROP(DecisionList, BehindARuleThatSaysTheSameAPositionIsAsGoodAsBeforeIt, ()) {
  const DecisionList list = any_list();
  const TermSpace& space = scene().space;
  const std::vector<std::uint16_t> deciding = deciding_rules(list, space.size());
  for (const bool is_in : {true, false}) {
    for (std::size_t position = 1; position <= list.size(); ++position) {
      if (list[position - 1].is_in != is_in) continue;
      RC_ASSERT(insertion_gains(list, deciding, space.pulls, position, is_in) ==
                insertion_gains(list, deciding, space.pulls, position - 1, is_in));
    }
  }
}

TEST(DecisionList, AtItsLimitOfWorkAddsSimpleTermsOnly) {
  const TermSpace& space = scene().space;
  const DecisionList hurried = search_list(space, k_costs, {.rules = 20, .work = 0});
  ASSERT_GT(hurried.size(), 1U);
  const auto is_simple = [](const Rule& rule) { return rule.term.parts.size() == 1; };
  EXPECT_LE(std::ranges::count_if(hurried, std::not_fn(is_simple)), 1) << "the first rule is chosen among all terms";
  const double cost = cost_of(hurried, space.pulls, k_costs);
  EXPECT_LT(cost, cost_of({}, space.pulls, k_costs));
  EXPECT_GE(cost, cost_of(search_list(space, k_costs, {.rules = 20}), space.pulls, k_costs));
}

RC_GTEST_PROP(WriteSolids, TheTreeDecidesAsTheListDoes, ()) {
  const DecisionList list = any_list();
  const TermSpace& space = scene().space;
  const WrittenSolids written = write_solids(space, list);
  // Places were merged by kind, so hold the tree against the cost of its own decisions on all of them.
  double of_list = 0;
  const std::vector<std::uint16_t> deciding = deciding_rules(list, space.size());
  for (std::size_t i = 0; i < space.size(); ++i) {
    if (deciding[i] < list.size() && list[deciding[i]].is_in) of_list += space.pulls[i];
  }
  double of_tree = 0;
  const std::vector<double> values = implicit_value(written.tree, written.solids, scene().places.positions);
  for (std::size_t i = 0; i < values.size(); ++i) of_tree += values[i] < 0 ? scene().places.weights[i] : 0.0;
  // What adds ends with the part: far places, which are all out, may only be right more often.
  RC_ASSERT(of_tree >= of_list - 1e-9);
}

TEST(WriteSolids, NothingIsAddedFarFromThePart) {
  TermSpace space = scene().space;
  const auto cylinder = std::ranges::find_if(
      space.revolved, [](const RevolvedFamily& family) { return family.surface.type == SurfaceType::cylinder; });
  ASSERT_NE(cylinder, space.revolved.end());
  const TermPart part{.kind = PartKind::revolved,
                      .family = static_cast<std::uint32_t>(cylinder - space.revolved.begin()),
                      .ranges = {BinRange{.first = 0, .last = cylinder->bins.count() - 1}}};
  const Term term{.parts = {part}};
  const DecisionList list{{.term = term, .members = members_of(space, term), .is_in = true}};
  const auto is_inside = [](const WrittenSolids& written, const Eigen::Vector3d& place) {
    Points places;
    places.push_back(place);
    return implicit_value(written.tree, written.solids, places)[0] < 0;
  };
  const Eigen::Vector3d in_part = cylinder->surface.position;
  const Eigen::Vector3d far =
      in_part + 20 * space.part_bounds.diagonal().norm() * cylinder->surface.axis.unitOrthogonal();
  EXPECT_EQ(write_solids(space, list).solids.size(), 1U) << "a solid of the part's size needs no box";
  cylinder->surface.radius = 30 * space.part_bounds.diagonal().norm();
  const WrittenSolids written = write_solids(space, list);
  EXPECT_TRUE(is_inside(written, in_part));
  EXPECT_FALSE(is_inside(written, far));
}

TEST(WriteSolids, WhatSubtractsEverythingButASolidIsWrittenAsThatSolid) {
  const TermSpace& space = scene().space;
  const auto box_within = [&](std::uint32_t bins) {
    TermPart box;
    for (std::size_t side = 0; side < 3; ++side)
      box.ranges[side] = {bins, space.boxes[0].bins[side].count() - 1 - bins};
    return box;
  };
  TermPart round{.kind = PartKind::revolved, .ranges = {BinRange{0, space.revolved[0].bins.count() - 1}}};
  const auto rule_of = [&](const Term& term, bool is_in) {
    return Rule{.term = term, .members = members_of(space, term), .is_in = is_in};
  };
  const auto text_of = [&](std::uint32_t bins) {
    const Rule subtracts = rule_of({.parts = {box_within(bins), round}}, false);
    const WrittenSolids written = write_solids(space, {subtracts, rule_of({.parts = {box_within(1)}}, true)});
    return to_text(written.tree, written.solids);
  };
  EXPECT_EQ(text_of(0), "box_0 - cylinder_0") << "the cylinder of everything";
  round.is_inverted = true;
  EXPECT_EQ(text_of(0), "box_0 & cylinder_0") << "everything but the cylinder";
  EXPECT_EQ(text_of(1), "box_0 & cylinder_0") << "all of the part but the cylinder";
  EXPECT_EQ(text_of(2), "box_1 - (box_0 - cylinder_0)") << "only some of the part";
}

RC_GTEST_PROP(TermSearch, TheBestBoxIsNoWorseThanAnyOther, ()) {
  const TermSpace& space = scene().space;
  const std::vector<double> gains = any_gains();
  const PricedTerm best = best_box(space, 0, gains, k_costs, 0);
  const PricedTerm overall = best_term(space, gains, k_costs);
  for (int k = 0; k < 5; ++k) {
    const Rule rule = any_rule();
    double net = -cost_of(rule.term, k_costs);
    for (std::size_t i = 0; i < gains.size(); ++i) net += rule.members[i] != 0 ? gains[i] : 0.0;
    if (rule.term.parts[0].kind == PartKind::box) RC_ASSERT(net <= std::max(best.net, 0.0) + 1e-9);
    RC_ASSERT(net <= std::max(overall.net, 0.0) + 1e-9);
  }
}

/// An interval of one curved surface, and the inside or outside of another.
std::vector<Term> all_pairs(const TermSpace& space) {
  std::vector<Term> pairs;
  for (std::uint32_t first = 0; first < space.revolved.size(); ++first) {
    for (std::uint32_t second = 0; second < space.revolved.size(); ++second) {
      if (second == first) continue;
      TermPart a{.kind = PartKind::revolved, .family = first};
      TermPart b{.kind = PartKind::revolved, .family = second};
      b.ranges[0] = {0, space.revolved[second].bins.count() - 1};
      for (const bool is_inverted : {false, true}) {
        b.is_inverted = is_inverted;
        for (std::uint32_t from = 0; from < space.revolved[first].bins.count(); ++from) {
          for (std::uint32_t to = from; to < space.revolved[first].bins.count(); ++to) {
            a.ranges[0] = {from, to};
            pairs.push_back({.parts = {a, b}});
          }
        }
      }
    }
  }
  return pairs;
}

RC_GTEST_PROP(TermSearch, NoPairOfCurvedSolidsIsBetter, ()) {
  const TermSpace& space = scene().space;
  RC_ASSERT(space.revolved.size() == 2U);
  // What is inside of one, and mostly of the other or not, gains: such a pair is best then.
  const bool is_common = *rc::gen::arbitrary<bool>();
  std::vector<double> gains = any_gains();
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const bool is_in = space.revolved[0].is_inside[i] != 0 && (space.revolved[1].is_inside[i] != 0) == is_common;
    if (is_in && *rc::gen::inRange(0, 4) > 0) gains[i] = 0.5;
  }
  const PricedTerm best = best_term(space, gains, k_costs);
  for (const Term& pair : all_pairs(space)) {
    const std::vector<std::uint8_t> members = members_of(space, pair);
    double net = -cost_of(pair, k_costs);
    for (std::size_t i = 0; i < gains.size(); ++i) net += members[i] != 0 ? gains[i] : 0.0;
    RC_ASSERT(net <= std::max(best.net, 0.0) + 1e-9);
  }
}

RC_GTEST_PROP(TermSearch, ANetIsWhatTheMembersGain, ()) {
  const TermSpace& space = scene().space;
  const std::vector<double> gains = any_gains();
  const PricedTerm best = best_term(space, gains, k_costs);
  if (best.term.parts.empty()) return;  // nothing gains
  const std::vector<std::uint8_t> members = members_of(space, best.term);
  double net = -cost_of(best.term, k_costs);
  for (std::size_t i = 0; i < gains.size(); ++i) net += members[i] != 0 ? gains[i] : 0.0;
  RC_ASSERT(std::abs(net - best.net) < 1e-9);
}

}  // namespace
}  // namespace cloud2csg
