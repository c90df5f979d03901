#include "shape/sample/neighbourhood.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "support/random_scene.hpp"

namespace cloud2csg::test {
namespace {

/// Points on the surface of a solid, as far as a step along the gradient finds them, and around.
Points around(const Primitive& primitive, const PrimitiveSet& primitives, RandomStream& random) {
  Points points;
  for (int i = 0; i < 50; ++i) points.push_back(random_position({primitive}, random));
  for (int i = 0; i < 20; ++i) points.push_back(random_position(primitives, random));
  return points;
}

RC_GTEST_PROP(Neighbourhood, ContainsWhatTheWholeTreeDoes, (std::uint64_t seed)) {
  RandomStream random(seed);
  const PrimitiveSet primitives = random_primitives(1 + random.below(12), random);
  const CsgTree tree = random_formula(primitives.size(), 1 + random.below(24), random);
  const std::vector<PrimitiveIndex> used = primitives_of(tree);
  constexpr double k_margin = 0.01;
  const std::vector<Neighbourhood> all = neighbourhoods({.primitives = primitives, .tree = tree}, used, k_margin);
  RC_ASSERT(all.size() == used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    AlignedBox reach = bounds(primitives[used[i]]);
    reach.min().array() -= k_margin;
    reach.max().array() += k_margin;
    const Points points = around(primitives[used[i]], primitives, random);
    const std::vector<double> whole = implicit_value(tree, primitives, points);
    const std::vector<double> local = implicit_value(all[i].tree, all[i].primitives, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (reach.contains(points[k])) RC_ASSERT((whole[k] < 0) == (local[k] < 0));
    }
  }
}

TEST(Neighbourhood, LeavesOutWhatIsFarAway) {
  PrimitiveSet row;
  std::vector<CsgTree> leaves;
  for (PrimitiveIndex i = 0; i < 9; ++i) {
    row.push_back({.id = "p", .shape = Sphere{0.6}, .pose = {.position = {static_cast<double>(i), 0, 0}}});
    leaves.push_back(CsgTree::leaf(i));
  }
  row.push_back({.id = "h", .shape = HalfSpace{}});
  const CsgTree tree = subtract(unite_all(leaves), CsgTree::leaf(9));
  const std::vector<Neighbourhood> all = neighbourhoods({.primitives = row, .tree = tree}, primitives_of(tree), 0.01);
  EXPECT_EQ(all[4].members, (std::vector<PrimitiveIndex>{3, 4, 5, 9}));
  EXPECT_EQ(all[4].tree, parse_tree("(p | q | r) - h", {{.id = "p", .shape = Sphere{1}},
                                                        {.id = "q", .shape = Sphere{1}},
                                                        {.id = "r", .shape = Sphere{1}},
                                                        {.id = "h", .shape = HalfSpace{}}}));
  EXPECT_EQ(all[9].members.size(), 10U);
  EXPECT_EQ(all[9].tree, tree);
}

}  // namespace
}  // namespace cloud2csg::test
