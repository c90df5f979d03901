#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cloud2csg/advanced/restrict.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/sample.hpp"
#include "paper/merge/merge_component.hpp"
#include "support/known_solids.hpp"
#include "support/scene.hpp"

namespace cloud2csg {
namespace {

/// A block with a bore, and a small knob on its side; the knob does not reach the bore.
class MergeCheckOfABlock : public ::testing::Test {
 protected:
  MergeCheckOfABlock()
      : primitives_{test::placed("block", Box{{2, 2, 1}}, {0, 0, 0}), test::placed("bore", Cylinder{0.4, 2}, {0, 0, 0}),
                    test::placed("knob", Sphere{0.15}, {1, 0, 0})},
        scene_{.primitives = primitives_,
               .cloud = sample_surface({.primitives = primitives_, .tree = tree("(block | knob) - bore")},
                                       {.count = 12'000, .noise = 0.005, .seed = 1})},
        table_(test::whole_table(scene_)) {}

  [[nodiscard]] CsgTree tree(const char* text) const { return parse_tree(text, primitives_); }

  [[nodiscard]] MergeCheck check_of(const std::vector<const char*>& texts) const {
    std::vector<CsgTree> trees;
    trees.reserve(texts.size());
    for (const char* text : texts) trees.push_back(tree(text));
    return MergeCheck({{.table = &table_, .primitives = {0, 1, 2}}}, 3, table_.objective().alpha, cliques_, trees);
  }

  [[nodiscard]] static double shortfall(const MergeCheck& check, const CsgTree& merged) {
    return check.judge(merged).worst_shortfall;
  }

  PrimitiveSet primitives_;
  test::Scene scene_;
  RankClasses table_;
  std::vector<Clique> cliques_{{0, 1}, {0, 2}};
};

TEST_F(MergeCheckOfABlock, TheTruthKeepsWhatItsPartsPromise) {
  const MergeCheck check = check_of({"block - bore", "block | knob"});
  EXPECT_LT(shortfall(check, tree("(block | knob) - bore")), 0.02);
  EXPECT_LT(shortfall(check, tree("(block - bore) | knob")), 0.02);
}

TEST_F(MergeCheckOfABlock, ALostFeatureShowsHoweverSmallItIs) {
  const MergeCheck check = check_of({"block - bore", "block | knob"});
  EXPECT_GT(shortfall(check, tree("block - bore")), 0.3);  // the knob weighs 1 % of the points
  EXPECT_GT(shortfall(check, tree("block | knob")), 0.3);
  EXPECT_GT(shortfall(check, tree("(block | bore) | knob")), 0.3);
  EXPECT_GT(shortfall(check, tree("(block - knob) - bore")), 0.3);
  EXPECT_GT(shortfall(check, tree("bore")), 0.9);
}

TEST_F(MergeCheckOfABlock, NothingAtAllMissesEverything) {
  const MergeCheck check = check_of({"block - bore", "block | knob"});
  EXPECT_EQ(shortfall(check, CsgTree::empty()), 1.0);
}

TEST_F(MergeCheckOfABlock, AnswersForPrimitivesOnlyThatAPartitionKnows) {
  // Nobody promised the knob, so losing it is no shortfall.
  cliques_ = {{0, 1}};
  const MergeCheck check = check_of({"block - bore"});
  EXPECT_LT(shortfall(check, tree("block - bore")), 0.02);
}

TEST_F(MergeCheckOfABlock, OfPartitionsThatDisagreeTheBetterPromises) {
  cliques_ = {{0, 1}, {0, 1}, {0, 2}};
  const MergeCheck check = check_of({"block | bore", "block - bore", "block | knob"});
  EXPECT_LT(shortfall(check, tree("(block | knob) - bore")), 0.02);
  EXPECT_GT(shortfall(check, tree("(block | knob) | bore")), 0.3);
}

/// A row of blocks with a bore in each third; each overlaps the next only. Judged by one table over all, and by windows
/// of each primitive's points with it and its neighbours.
class MergeCheckInWindows : public ::testing::Test {
 protected:
  MergeCheckInWindows() {
    std::string id("a");
    for (PrimitiveIndex p = 0; p < k_count; ++p, ++id[0]) {
      const Shape shape = is_bore(p) ? Shape(Cylinder{0.2, 2}) : p % 3 == 0 ? Shape(Box{{1, 1, 0.6}}) : Sphere{0.45};
      primitives_.push_back(test::placed(id, shape, {0.6 * p, 0, 0}));
    }
    truth_ = tree("(a | c | d | f | g | i) - (b | e | h)");
    scene_ = {.primitives = primitives_,
              .cloud = sample_surface({.primitives = primitives_, .tree = truth_},
                                      {.count = 20'000, .noise = 0.005, .seed = 1})};
    std::vector<RankClassesRequest> requests{{.primitives = test::all_of(primitives_)}};
    for (PrimitiveIndex p = 0; p < k_count; ++p) {
      RankClassesRequest window{.primitives = {}, .owners = {p}};
      for (PrimitiveIndex q = p > 0 ? p - 1 : 0; q < std::min(k_count, p + 2); ++q) window.primitives.push_back(q);
      requests.push_back(window);
    }
    pass_ = test::pass_over(scene_, requests);
    for (PrimitiveIndex p = 0; p + 1 < k_count; ++p) {
      cliques_.push_back({p, p + 1});
      trees_.push_back(restrict_to(truth_, cliques_.back()));
    }
  }

  static constexpr PrimitiveIndex k_count = 9;
  static bool is_bore(PrimitiveIndex p) { return p % 3 == 1; }

  [[nodiscard]] CsgTree tree(const char* text) const { return parse_tree(text, primitives_); }

  [[nodiscard]] MergeCheck by_one_table() const {
    return MergeCheck({{.table = &pass_.tables[0], .primitives = test::all_of(primitives_)}}, k_count, alpha(),
                      cliques_, trees_);
  }

  [[nodiscard]] MergeCheck by_windows() const {
    std::vector<MergeWindow> windows;
    for (PrimitiveIndex p = 0; p < k_count; ++p) {
      const std::span<const PrimitiveIndex> set = pass_.tables[p + 1].primitives();
      windows.push_back({.table = &pass_.tables[p + 1], .primitives = {set.begin(), set.end()}, .judged = p});
    }
    return {windows, k_count, alpha(), cliques_, trees_};
  }

  [[nodiscard]] double alpha() const { return pass_.tables[0].objective().alpha; }

  PrimitiveSet primitives_;
  CsgTree truth_;
  test::Scene scene_;
  PointPass pass_;
  std::vector<Clique> cliques_;
  std::vector<CsgTree> trees_;
};

/// Where a tree is wrong, what it is at a point may be told by a primitive that is not in the window, whose surface may
/// have the right direction by chance: how much is missing differs, that it is does not.
TEST_F(MergeCheckInWindows, AgreesWithOneTable) {
  const MergeCheck one = by_one_table();
  const MergeCheck windows = by_windows();
  for (const char* text :
       {"(a | c | d | f | g | i) - (b | e | h)", "((a - b) | c | d | f | g | i) - (e | h)",
        "((a | c) - b) | (d - e) | f | (g - h) | i", "(a | c | d | f | g) - (b | e | h)",
        "(a | c | d | f | g | i) - (b | e)", "(a | c | d | e | f | g | i) - (b | h)", "a - b", "a", "empty"}) {
    const CsgTree candidate = simplify(tree(text));
    const MergeCheck::Verdict expected = one.judge(candidate);
    const MergeCheck::Verdict verdict = windows.judge(candidate);
    EXPECT_NEAR(verdict.worst_shortfall, expected.worst_shortfall, expected.worst_shortfall < 0.1 ? 0.01 : 0.15)
        << text;
    EXPECT_NEAR(verdict.score, expected.score,
                (expected.worst_shortfall < 0.1 ? 0.01 : 0.05) * one.judge(truth_).score);
  }
}

/// What is judged in parts is judged as a whole is: the parts of a primitive's points add up.
TEST_F(MergeCheckInWindows, OfOnePrimitiveAddUp) {
  std::vector<RankClassesRequest> requests;
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  for (PrimitiveIndex p = 0; p < k_count; ++p) {
    const std::span<const PrimitiveIndex> set = pass_.tables[p + 1].primitives();
    AlignedBox below(Eigen::Vector3d::Constant(-k_infinity), Eigen::Vector3d::Constant(k_infinity));
    AlignedBox above = below;
    below.max().y() = above.min().y() = 0.1;
    for (const AlignedBox& region : {below, above}) {
      requests.push_back({.primitives = {set.begin(), set.end()}, .owners = {p}, .region = region});
    }
  }
  const PointPass halves = test::pass_over(scene_, requests);
  std::vector<MergeWindow> windows;
  for (std::size_t w = 0; w < requests.size(); ++w) {
    windows.push_back(
        {.table = &halves.tables[w], .primitives = requests[w].primitives, .judged = requests[w].owners.front()});
  }
  const MergeCheck in_halves(windows, k_count, alpha(), cliques_, trees_);
  const MergeCheck whole = by_windows();
  std::vector<PrimitiveIndex> without_bore = test::all_of(primitives_);
  std::erase(without_bore, PrimitiveIndex{4});
  for (const CsgTree& tree : {truth_, restrict_to(truth_, without_bore), CsgTree::leaf(0), CsgTree::empty()}) {
    EXPECT_NEAR(in_halves.judge(tree).score, whole.judge(tree).score, 1e-6 * std::abs(whole.judge(tree).score));
    EXPECT_NEAR(in_halves.judge(tree).worst_shortfall, whole.judge(tree).worst_shortfall, 0.02);
  }
}

/// A window that has no partition's primitives whole still tells whether the judged primitive is there.
TEST_F(MergeCheckInWindows, PromiseWithoutWholePartitions) {
  std::vector<RankClassesRequest> requests;
  std::vector<MergeWindow> windows;
  for (PrimitiveIndex p = 0; p < k_count; ++p) requests.push_back({.primitives = {p}});
  const PointPass alone = test::pass_over(scene_, requests);
  for (PrimitiveIndex p = 0; p < k_count; ++p) {
    windows.push_back({.table = &alone.tables[p], .primitives = {p}, .judged = p});
  }
  const MergeCheck check(windows, k_count, alpha(), cliques_, trees_);
  EXPECT_LT(check.judge(truth_).worst_shortfall, 0.02);
  std::vector<PrimitiveIndex> others = test::all_of(primitives_);
  std::erase(others, PrimitiveIndex{6});
  EXPECT_EQ(check.judge(restrict_to(truth_, others)).worst_shortfall, 1.0);
}

TEST_F(MergeCheckInWindows, FindsWhatIsLostAnywhere) {
  const MergeCheck windows = by_windows();
  EXPECT_LT(windows.judge(truth_).worst_shortfall, 0.02);
  for (PrimitiveIndex lost = 0; lost < k_count; ++lost) {
    std::vector<PrimitiveIndex> others = test::all_of(primitives_);
    std::erase(others, lost);
    const CsgTree without = restrict_to(truth_, others);
    EXPECT_GT(windows.judge(without).worst_shortfall, 0.3) << lost;
    EXPECT_LT(windows.judge(without).score, windows.judge(truth_).score);
    const CsgTree turned =
        simplify(is_bore(lost) ? unite(truth_, CsgTree::leaf(lost)) : subtract(truth_, CsgTree::leaf(lost)));
    EXPECT_GT(windows.judge(turned).worst_shortfall, 0.3) << lost;
  }
  EXPECT_EQ(windows.judge(CsgTree::empty()).worst_shortfall, 1.0);
}

}  // namespace
}  // namespace cloud2csg
