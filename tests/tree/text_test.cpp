#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "support/structurally_equal.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

CsgTree p(PrimitiveIndex index) {
  return CsgTree::leaf(index);
}

TEST(TreeText, ReadsEveryOperation) {
  const PrimitiveSet primitives = test::sphere_row(3);
  EXPECT_EQ(parse_tree("p0", primitives), p(0));
  EXPECT_EQ(parse_tree(" ( p0 | p1 ) - p2 ", primitives), subtract(unite(p(0), p(1)), p(2)));
  EXPECT_EQ(parse_tree("p0 & ~(empty|full)", primitives),
            intersect(p(0), complement(unite(CsgTree::empty(), CsgTree::full()))));
}

TEST(TreeText, BindsComplementThenIntersectionThenTheOthersFromTheLeft) {
  const PrimitiveSet primitives = test::sphere_row(3);
  EXPECT_EQ(parse_tree("~p0 & p1", primitives), intersect(complement(p(0)), p(1)));
  EXPECT_EQ(parse_tree("p0 | p1 & p2", primitives), unite(p(0), intersect(p(1), p(2))));
  EXPECT_EQ(parse_tree("p0 | p1 - p2", primitives), subtract(unite(p(0), p(1)), p(2)));
  EXPECT_EQ(parse_tree("p0 - p1 | p2", primitives), unite(subtract(p(0), p(1)), p(2)));
  EXPECT_EQ(parse_tree("~~p0", primitives), complement(complement(p(0))));
}

TEST(TreeText, IsWrittenWithParenthesesBetweenOperations) {
  const PrimitiveSet primitives = test::sphere_row(4);
  EXPECT_EQ(to_text(subtract(unite(p(0), p(1)), p(2)), primitives), "(p0 | p1) - p2");
  EXPECT_EQ(to_text(subtract(p(0), subtract(p(1), p(2))), primitives), "p0 - (p1 - p2)");
  EXPECT_EQ(to_text(subtract(subtract(p(0), p(1)), p(2)), primitives), "p0 - p1 - p2");
  EXPECT_EQ(to_text(unite(unite(p(0), p(1)), unite(p(2), p(3))), primitives), "p0 | p1 | p2 | p3");
  EXPECT_EQ(to_text(complement(intersect(p(0), complement(p(1)))), primitives), "~(p0 & ~p1)");
}

TEST(TreeText, QuotesUnusualIds) {
  PrimitiveSet primitives = test::sphere_row(5);
  const std::vector<std::string> ids{"box 1", "empty", "a\"b\\c", "", "größe"};
  for (std::size_t i = 0; i < ids.size(); ++i) primitives[i].id = ids[i];
  const CsgTree tree = unite_all(std::vector{p(0), p(1), p(2), p(3), p(4)});
  EXPECT_EQ(to_text(tree, primitives), R"("box 1" | "empty" | "a\"b\\c" | "" | größe)");
  EXPECT_EQ(parse_tree(to_text(tree, primitives), primitives), tree);
}

RC_GTEST_PROP(TreeText, ComesBackAsTheSameTreeUpToAssociation, (const CsgTree& tree)) {
  const PrimitiveSet primitives = test::sphere_row(6);
  const CsgTree back = parse_tree(to_text(tree, primitives), primitives);
  RC_ASSERT(test::is_well_formed(back));
  RC_ASSERT(test::structurally_equal(back, tree));
}

struct Mistake {
  std::string text, where, found;
};

class TreeTextMistake : public testing::TestWithParam<Mistake> {};

TEST_P(TreeTextMistake, IsReportedWithItsColumn) {
  const PrimitiveSet primitives = test::sphere_row(3);
  try {
    static_cast<void>(parse_tree(GetParam().text, primitives));
    FAIL() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, GetParam().where);
    EXPECT_NE(error.parts().expected.find(GetParam().found), std::string::npos) << error.what();
    EXPECT_FALSE(error.parts().remedy.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(All, TreeTextMistake,
                         testing::Values(Mistake{"", "column 1", "the end"}, Mistake{"p0 |", "column 5", "the end"},
                                         Mistake{"p0 p1", "column 4", "p1"}, Mistake{"p0 | | p1", "column 6", "'|'"},
                                         Mistake{"(p0 - p1", "column 1", "never closed"},
                                         Mistake{"p0) | p1", "column 3", "')'"}, Mistake{"()", "column 2", "')'"},
                                         Mistake{"p0 + p1", "column 4", "'+'"}, Mistake{"p0 ~p1", "column 4", "'~'"},
                                         Mistake{"p0 & p9", "column 6", "p9"}, Mistake{"~", "column 2", "the end"},
                                         Mistake{"p0 | \"p1", "column 6", "closing quote"},
                                         Mistake{"p0 (p1)", "column 4", "'('"}, Mistake{"\"ä\" | p0", "column 1", "ä"},
                                         Mistake{"p0 & ää", "column 6", "ää"},
                                         Mistake{"p0 | ~(p1 & \"ä", "column 13", "closing quote"}));

}  // namespace
}  // namespace cloud2csg
