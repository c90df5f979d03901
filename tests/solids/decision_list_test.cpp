#include "raw/solids/decision_list.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/sample.hpp"
#include "raw/solids/list_search.hpp"
#include "raw/solids/outline.hpp"
#include "raw/solids/write_solids.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr TermCosts k_costs{};

/// A term space over a part of boxes, a cylinder, a sphere and a quarter of a cone, and the places it was made from.
struct Scene {
  LabelledPlaces places;
  TermSpace space;
};

const Scene& scene() {
  static const Scene made = [] {
    const PrimitiveSet solids{
        test::placed("a", Box{{4, 3, 1}}, {0, 0, 0}),    test::placed("b", Box{{1, 1, 2}}, {1, 0, 1}),
        test::placed("c", Cylinder{0.5, 3}, {-1, 0, 0}), test::placed("d", Sphere{0.6}, {-0.6, 0.3, 0.4}),
        test::placed("e", Cone{1.2, 0.8, 1}, {0, 3, 0}), test::placed("f", Box{{2, 2, 2}}, {1, 4, 0})};
    const CsgTree tree = parse_tree("((a | b) - c) | d | e & f", solids);
    const PointCloud cloud = sample_surface({.primitives = solids, .tree = tree}, {.count = 3000, .seed = 2});
    Scene result;
    result.places = label_places(cloud, {.noise = 0.0, .volume_places = 3000, .surface_points = 1000});
    result.space = with_places(make_term_space(cloud.positions, test::known_surfaces(solids, cloud, 0.01),
                                               {.tolerance = 0.01, .spacing = estimate_scale(cloud).spacing}),
                               result.places);
    return result;
  }();
  return made;
}

BinRange any_range(std::uint32_t bins) {
  const std::uint32_t first = *rc::gen::inRange(0U, bins);
  return {first, *rc::gen::inRange(first, bins)};
}

/// The profile of all faces between two of the most slabs, counted from both ends.
TermPart everything_within(const TermSpace& space, std::uint32_t slabs) {
  const auto family =
      std::ranges::max_element(space.profiles, {}, [](const ProfileFamily& f) { return f.slabs.count(); });
  TermPart part{.kind = PartKind::profile,
                .family = static_cast<std::uint32_t>(family - space.profiles.begin()),
                .range = {slabs, family->slabs.count() - 1 - slabs}};
  part.faces.assign(family->chart.drawing.arrangement.areas.size(), 1);
  part.faces[0] = 0;
  return part;
}

TermPart any_profile() {
  const TermSpace& space = scene().space;
  const auto index = *rc::gen::inRange(0U, static_cast<std::uint32_t>(space.profiles.size()));
  const ProfileFamily& family = space.profiles[index];
  const Drawing& drawing = family.chart.drawing;
  TermPart part{.kind = PartKind::profile, .family = index};
  // Extrusions end at caps, not beyond the part.
  if (family.chart.is_turned) {
    part.range = any_range(family.slabs.count());
  } else {
    part.range = any_range(family.slabs.count() - 2);
    part.range = {part.range.first + 1, part.range.last + 1};
  }
  std::vector<double> gains(drawing.arrangement.areas.size());
  for (int attempt = 0; attempt < 20; ++attempt) {
    for (double& gain : gains) gain = *rc::gen::inRange(-8, 8);
    part.faces = choose_faces(drawing, gains, 0);
    part.segments = segments_of(drawing, part.faces);
    if (is_writable(drawing, part.faces)) return part;
  }
  return everything_within(space, 1);
}

TermPart any_part() {
  if (*rc::gen::arbitrary<bool>()) return any_profile();
  const TermSpace& space = scene().space;
  TermPart part{.kind = PartKind::revolved};
  part.family = *rc::gen::inRange(0U, static_cast<std::uint32_t>(space.revolved.size()));
  part.range = any_range(space.revolved[part.family].bins.count());
  return part;
}

/// An extrusion, a revolution or a curved solid, or what one has in common with the inside or outside of another.
Rule any_rule() {
  Rule rule{.term = {.parts = {any_part()}}, .members = {}, .is_in = *rc::gen::arbitrary<bool>()};
  if (*rc::gen::arbitrary<bool>()) {
    TermPart second = any_part();
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

/// Else the next test would know no sectors.
TEST(WriteSolids, TheSceneHasASector) {
  EXPECT_TRUE(std::ranges::any_of(scene().space.profiles, [](const ProfileFamily& family) {
    return family.chart.is_turned && family.slabs.count() > 1;
  }));
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
                      .range = {.first = 0, .last = cylinder->bins.count() - 1}};
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
  TermPart round{.kind = PartKind::revolved, .range = {0, space.revolved[0].bins.count() - 1}};
  const auto rule_of = [&](const Term& term, bool is_in) {
    return Rule{.term = term, .members = members_of(space, term), .is_in = is_in};
  };
  const auto text_of = [&](const TermPart& first) {
    const Rule subtracts = rule_of({.parts = {first, round}}, false);
    const WrittenSolids written =
        write_solids(space, {subtracts, rule_of({.parts = {everything_within(space, 1)}}, true)});
    return to_text(written.tree, written.solids);
  };
  EXPECT_EQ(text_of({.kind = PartKind::polytope}), "box_0 - cylinder_0") << "the cylinder of everything";
  round.is_inverted = true;
  EXPECT_EQ(text_of({.kind = PartKind::polytope}), "box_0 & cylinder_0") << "everything but the cylinder";
  EXPECT_EQ(text_of(everything_within(space, 1)), "box_0 & cylinder_0") << "all of the part but the cylinder";
  EXPECT_EQ(text_of(everything_within(space, 2)), "box_1 - (box_0 - cylinder_0)") << "only some of the part";
}

double net_of(const Term& term, const TermSpace& space, std::span<const double> gains) {
  const std::vector<std::uint8_t> members = members_of(space, term);
  double net = -cost_of(term, k_costs);
  for (std::size_t i = 0; i < gains.size(); ++i) net += members[i] != 0 ? gains[i] : 0.0;
  return net;
}

RC_GTEST_PROP(TermSearch, NoCurvedSolidIsBetter, ()) {
  const TermSpace& space = scene().space;
  const std::vector<double> gains = any_gains();
  const PricedTerm best = best_term(space, gains, k_costs);
  for (std::uint32_t r = 0; r < space.revolved.size(); ++r) {
    const std::uint32_t bins = space.revolved[r].bins.count();
    for (std::uint32_t first = 0; first < bins; ++first) {
      for (std::uint32_t last = first; last < bins; ++last) {
        const Term one{.parts = {{.kind = PartKind::revolved, .family = r, .range = {first, last}}}};
        RC_ASSERT(net_of(one, space, gains) <= std::max(best.net, 0.0) + 1e-9);
      }
    }
  }
}

/// Gains that just one term explains: all of its places gain, all others lose.
RC_GTEST_PROP(TermSearch, FindsTheTermThatExplainsAllGains, ()) {
  const TermSpace& space = scene().space;
  TermPart profile = any_profile();
  profile.bare_leaves = 0;
  Term term{.parts = {profile}};
  if (*rc::gen::arbitrary<bool>()) {
    const auto family = *rc::gen::inRange(0U, static_cast<std::uint32_t>(space.revolved.size()));
    term.parts.push_back({.kind = PartKind::revolved,
                          .family = family,
                          .range = {0, space.revolved[family].bins.count() - 1},
                          .is_inverted = *rc::gen::arbitrary<bool>()});
  }
  const std::vector<std::uint8_t> members = members_of(space, term);
  std::vector<double> gains(members.size());
  double most = 0;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    gains[i] = members[i] != 0 ? 1 : -1;
    most += std::max(gains[i], 0.0);
  }
  RC_PRE(most > 0);
  const PricedTerm best = best_term(space, gains, k_costs);
  RC_ASSERT(best.net >= net_of(term, space, gains) - 1);  // without the price of bare surfaces, which is below 1
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
