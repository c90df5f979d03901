#include "cloud2csg/advanced/overlap_graph.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "overlap/random_solids.hpp"

namespace cloud2csg {
namespace {

std::vector<std::size_t> histogram_of(const std::string& model) {
  const Model read = read_model(std::string(CLOUD2CSG_DATA_DIR) + "/models/" + model);
  return clique_histogram(maximal_cliques(build_overlap_graph(read.primitives)));
}

// The table of the paper. M2 is a grid whose spheres meet their neighbours along the axes and the diagonals.
TEST(OverlapGraphOfThePaper, M0) {
  EXPECT_EQ(histogram_of("m0.json"), (std::vector<std::size_t>{0, 8, 4, 0, 1, 1}));
}
TEST(OverlapGraphOfThePaper, M1) {
  EXPECT_EQ(histogram_of("m1.json"), (std::vector<std::size_t>{0, 0, 2}));
}
TEST(OverlapGraphOfThePaper, M2) {
  EXPECT_EQ(histogram_of("m2.json"), (std::vector<std::size_t>{0, 0, 0, 12}));
}

RC_GTEST_PROP(BuildOverlapGraph, BroadPhaseLosesNoPair, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const double tolerance = random.chance(0.5) ? 1e-6 : 0.2;
  PrimitiveSet primitives;
  for (int i = 0; i < 20; ++i) {
    primitives.push_back(test::random_convex(random));
    primitives.back().pose.position *= 2;
  }
  primitives.push_back(test::placed(HalfSpace{}, random));
  primitives.push_back(test::placed(HalfSpace{}, random));
  const OverlapGraph graph = build_overlap_graph(primitives, {.tolerance = tolerance});
  RC_ASSERT(graph.size() == primitives.size());
  for (PrimitiveIndex a = 0; a < primitives.size(); ++a) {
    RC_ASSERT(std::is_sorted(graph.neighbours[a].begin(), graph.neighbours[a].end()));
    RC_ASSERT(!graph.has_edge(a, a));
    for (PrimitiveIndex b = 0; b < a; ++b) {
      const OverlapGraph pair = build_overlap_graph({primitives[a], primitives[b]}, {.tolerance = tolerance});
      RC_ASSERT(graph.has_edge(a, b) == pair.has_edge(0, 1));
      RC_ASSERT(graph.has_edge(a, b) == graph.has_edge(b, a));
    }
  }
}

TEST(BuildOverlapGraph, GridOfTouchingBoxesIsAGrid) {
  PrimitiveSet boxes;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 3; ++j) {
      boxes.push_back({.id = "b", .shape = Box{.size = {0.1, 0.1, 0.1}}, .pose = {.position = {0.1 * i, 0.1 * j, 0}}});
    }
  }
  // Faces 3 x 3 + 4 x 2, edges (diagonals) 2 x 3 x 2.
  EXPECT_EQ(build_overlap_graph(boxes).edge_count(), 29U);
}

TEST(BuildOverlapGraph, ExtentBoundsAHalfSpace) {
  PrimitiveSet primitives{{.id = "ground", .shape = HalfSpace{}},
                          {.id = "near", .shape = Sphere{.radius = 1}, .pose = {.position = {0, 0, 0.5}}},
                          {.id = "far", .shape = Sphere{.radius = 1}, .pose = {.position = {50, 0, 0.5}}}};
  EXPECT_EQ(build_overlap_graph(primitives).edge_count(), 2U);
  const OrientedBox patch{.pose = {}, .half_size = {2, 2, 0}};
  const OverlapGraph graph = build_overlap_graph(primitives, {.extents = {patch}});
  EXPECT_TRUE(graph.has_edge(0, 1));
  EXPECT_FALSE(graph.has_edge(0, 2));
}

TEST(BuildOverlapGraph, ExtentOfABoundedPrimitiveIsIgnored) {
  const PrimitiveSet primitives{{.id = "a", .shape = Sphere{.radius = 1}},
                                {.id = "b", .shape = Sphere{.radius = 1}, .pose = {.position = {1, 0, 0}}}};
  const OrientedBox elsewhere{.pose = {.position = {9, 9, 9}}, .half_size = {1, 1, 1}};
  EXPECT_EQ(build_overlap_graph(primitives, {.extents = {elsewhere}}).edge_count(), 1U);
}

TEST(BuildOverlapGraph, RefusesBadOptionsByName) {
  const auto where = [](const OverlapOptions& options) -> std::string {
    try {
      (void)build_overlap_graph({}, options);
    } catch (const Error& error) {
      return error.parts().where;
    }
    return "accepted";
  };
  EXPECT_EQ(where({.tolerance = -1}), "tolerance");
  EXPECT_EQ(where({.tolerance = std::numeric_limits<double>::quiet_NaN()}), "tolerance");
  const OrientedBox infinite{.pose = {},
                             .half_size = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
  EXPECT_EQ(where({.extents = {std::nullopt, infinite}}), "extents[1]");
  EXPECT_EQ(where({}), "accepted");
}

TEST(BuildOverlapGraph, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  const PrimitiveSet primitives(2, {.id = "a", .shape = Sphere{.radius = 1}});
  EXPECT_THROW((void)build_overlap_graph(primitives, {}, {.stop = stop.get_token()}), Cancelled);
}

}  // namespace
}  // namespace cloud2csg
