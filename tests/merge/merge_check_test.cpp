#include "merge/merge_check.hpp"

#include <gtest/gtest.h>

#include "cloud2csg/sample.hpp"
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
               .cloud = sample_surface(tree("(block | knob) - bore"), primitives_,
                                       {.count = 12'000, .noise = 0.005, .seed = 1})},
        table_(test::whole_table(scene_)) {}

  [[nodiscard]] CsgTree tree(const char* text) const { return parse_tree(text, primitives_); }

  [[nodiscard]] MergeCheck check_of(const std::vector<const char*>& texts) const {
    std::vector<CsgTree> trees;
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

}  // namespace
}  // namespace cloud2csg
