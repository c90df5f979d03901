#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/extract.hpp"
#include "core/base/random.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"

/// Components that are too large for one table.
namespace cloud2csg {
namespace {

struct Known {
  PrimitiveSet primitives;
  CsgTree truth;
  PointCloud cloud;
};

/// Spheres on a jittered lattice, each of which overlaps its neighbours; every fifth is cut away from all the others.
Known lattice_of_spheres(int columns, int rows, int layers) {
  Known known;
  RandomStream random(3);
  std::vector<CsgTree> added, removed;
  for (int x = 0; x < columns; ++x) {
    for (int y = 0; y < rows; ++y) {
      for (int z = 0; z < layers; ++z) {
        const auto p = static_cast<PrimitiveIndex>(known.primitives.size());
        const Eigen::Vector3d jitter(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
        std::string id("s");
        id += std::to_string(p);
        known.primitives.push_back(
            test::placed(id, Sphere{random.uniform(0.58, 0.68)}, Eigen::Vector3d(x, y, z) + jitter));
        (p % 5 == 2 ? removed : added).push_back(CsgTree::leaf(p));
      }
    }
  }
  known.truth = subtract(unite_all(added), unite_all(removed));
  known.cloud = sample_surface({.primitives = known.primitives, .tree = known.truth},
                               {.count = 300 * known.primitives.size(), .noise = 0.004, .seed = 3});
  return known;
}

/// A plate with holes through it, bosses on it and dents in it: all overlap the plate, and none another.
Known plate_with_features(int columns, int rows) {
  Known known;
  const double width = columns + 0.5;
  const double depth = rows + 0.5;
  known.primitives.push_back(test::placed("plate", Box{{width, depth, 0.5}}, {0.5 * width, 0.5 * depth, 0}));
  CsgTree plate = CsgTree::leaf(0);
  std::vector<CsgTree> cuts;
  for (int k = 0; k < columns * rows; ++k) {
    const auto p = static_cast<PrimitiveIndex>(known.primitives.size());
    const int row = k / columns;
    const Eigen::Vector3d middle(k % columns + 0.75, row + 0.75, 0);
    std::string id("f");
    id += std::to_string(p);
    if (k % 3 == 0) {
      known.primitives.push_back(test::placed(id, Sphere{0.3}, middle + Eigen::Vector3d(0, 0, 0.3)));
    } else {
      known.primitives.push_back(
          test::placed(id, Cylinder{0.3, 1}, middle + Eigen::Vector3d(0, 0, k % 3 == 1 ? 0 : 0.4)));
    }
    if (k % 3 == 2) {
      plate = unite(plate, CsgTree::leaf(p));
    } else {
      cuts.push_back(CsgTree::leaf(p));
    }
  }
  known.truth = subtract(plate, unite_all(cuts));
  known.cloud = sample_surface({.primitives = known.primitives, .tree = known.truth},
                               {.count = 300 * known.primitives.size(), .noise = 0.004, .seed = 5});
  return known;
}

/// The tree is right, as small as the truth, and nothing is to be said about it.
void expect_truth(const Extraction& result, const Known& known) {
  EXPECT_GE(test::membership_iou(result.tree(), known.truth, known.primitives, 60), 0.9999)
      << to_text(result.tree(), known.primitives);
  EXPECT_EQ(result.tree().size(), simplify(known.truth).size()) << to_text(result.tree(), known.primitives);
  EXPECT_LT(result.statistics.merge.worst_shortfall, 0.05);
  EXPECT_TRUE(result.statistics.complete);
  EXPECT_TRUE(result.statistics.warnings.empty());
}

TEST(Hub, IsRightByCells) {
  const Known known = plate_with_features(9, 8);
  const Extraction result = extract_csg(known.cloud, known.primitives);
  expect_truth(result, known);
  ASSERT_TRUE(result.statistics.cells.has_value());
  EXPECT_TRUE(result.statistics.cells->is_minimal);
}

/// One primitive that overlaps all others is judged region by region.
TEST(Hub, IsRightByPartitions) {
  const Known known = plate_with_features(9, 8);
  const Extraction result = extract_csg(known.cloud, known.primitives, {.cell_trust = test::k_never_by_cells});
  expect_truth(result, known);
  EXPECT_FALSE(result.statistics.partitions.empty());
  for (const PartitionStatistics& partition : result.statistics.partitions) {
    EXPECT_LT(partition.points, known.cloud.size() / 8);  // not all of the plate's
  }
}

TEST(Hub, IsTheSameOnAnyNumberOfThreads) {
  const Known known = plate_with_features(6, 6);
  for (const ExtractOptions& options : test::with_and_without_cells()) {
    const Extraction expected = extract_csg(known.cloud, known.primitives, options, {.threads = 1});
    for (const int threads : {2, 0}) {
      EXPECT_EQ(extract_csg(known.cloud, known.primitives, options, {.threads = threads}).tree(), expected.tree())
          << threads;
    }
  }
}

class Lattice : public ::testing::Test {
 protected:
  static const Known& known() {
    static const Known lattice = lattice_of_spheres(7, 6, 1);
    return lattice;
  }

  [[nodiscard]] static Extraction extract(const ExtractOptions& options = {}, const RunContext& run = {}) {
    return extract_csg(known().cloud, known().primitives, options, run);
  }
};

TEST_F(Lattice, IsRightByCells) {
  const Extraction result = extract();
  expect_truth(result, known());
  EXPECT_EQ(result.statistics.components, 1U);
  ASSERT_TRUE(result.statistics.cells.has_value());
  EXPECT_TRUE(result.statistics.cells->is_minimal);
  EXPECT_TRUE(result.statistics.partitions.empty());
}

TEST_F(Lattice, IsRightByPartitions) {
  const Extraction result = extract({.cell_trust = test::k_never_by_cells});
  expect_truth(result, known());
  EXPECT_EQ(result.statistics.components, 1U);
  EXPECT_EQ(result.statistics.merge.ways, std::vector{MergeWay::dominance});
  EXPECT_GT(result.statistics.partitions.size(), 10U);
}

TEST_F(Lattice, IsTheSameForAnyThreadsAndModes) {
  for (ExtractOptions options : test::with_and_without_cells()) {
    options.parallel = Parallel::none;
    const Extraction expected = extract(options, {.threads = 1});
    for (const Parallel parallel : {Parallel::none, Parallel::population, Parallel::partitions, Parallel::both}) {
      options.parallel = parallel;
      const Extraction result = extract(options, {.threads = 2});
      EXPECT_EQ(result.tree(), expected.tree()) << to_string(parallel);
      EXPECT_EQ(result.statistics.fit.objective, expected.statistics.fit.objective);
      EXPECT_EQ(result.statistics.merge.worst_shortfall, expected.statistics.merge.worst_shortfall);
    }
  }
}

TEST_F(Lattice, OfPartitionsJudgedByAllTheirPointsGivesATreeThatFits) {
  const Extraction result = extract({.cell_trust = test::k_never_by_cells, .without_strangers = false});
  EXPECT_GE(test::membership_iou(result.tree(), known().truth, known().primitives), 0.95);
  EXPECT_TRUE(result.statistics.complete);
}

TEST_F(Lattice, EndsAtTheTimeLimitWithATree) {
  const Extraction result = extract({.cell_trust = test::k_never_by_cells, .time_limit_seconds = 1e-6});
  EXPECT_FALSE(result.statistics.complete);
  EXPECT_FALSE(primitives_of(result.tree()).empty());
}

/// Blocks apart from each other, each with a bore that reaches into the next one, which fills it: what is removed here
/// is hidden there, so that the order counts.
Known row_of_bores_that_are_filled(int blocks) {
  Known known;
  const Eigen::Quaterniond along_x(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  for (int i = 0; i < blocks; ++i) {
    std::string id("b");
    id += std::to_string(i);
    const auto p = static_cast<PrimitiveIndex>(known.primitives.size());
    known.primitives.push_back(test::placed(id, Box{{1, 1, 1}}, {1.2 * i, 0, 0}));
    known.truth = i == 0 ? CsgTree::leaf(p) : unite(known.truth, CsgTree::leaf(p));
    if (i + 1 == blocks) break;
    id[0] = 'c';
    known.primitives.push_back(test::placed(id, Cylinder{0.25, 0.9}, {1.2 * i + 0.5, 0, 0}));
    known.primitives.back().pose.orientation = along_x;
    known.truth = subtract(known.truth, CsgTree::leaf(p + 1));
  }
  known.cloud = sample_surface({.primitives = known.primitives, .tree = known.truth},
                               {.count = 500 * known.primitives.size(), .noise = 0.004, .seed = 3});
  return known;
}

TEST(FilledBores, AreCutOnlyWhereTheyShow) {
  const Known known = row_of_bores_that_are_filled(15);
  for (const ExtractOptions& options : test::with_and_without_cells()) {
    const Extraction result = extract_csg(known.cloud, known.primitives, options);
    EXPECT_GE(test::membership_iou(result.tree(), known.truth, known.primitives, 80), 0.9999)
        << to_text(result.tree(), known.primitives);
    EXPECT_EQ(result.tree().size(), known.truth.size());
    if (!result.statistics.cells) {
      EXPECT_EQ(result.statistics.merge.ways, std::vector{MergeWay::dominance});
    }
  }
}

/// A row of boxes of which only what two neighbours share is solid: each partition's tree is an intersection, and no
/// two of them merge.
Known row_of_intersections(int count) {
  Known known;
  std::vector<CsgTree> parts;
  for (int i = 0; i < count; ++i) {
    std::string id("b");
    id += std::to_string(i);
    // Of different widths, so that the sides of both show.
    const double width = i % 2 == 0 ? 1.0 : 0.8;
    known.primitives.push_back(test::placed(id, Box{{1.4, width, width}}, {1.0 * i, 0.15 * (i % 2), 0}));
    const auto p = static_cast<PrimitiveIndex>(i);
    if (i > 0) parts.push_back(intersect(CsgTree::leaf(p - 1), CsgTree::leaf(p)));
  }
  known.truth = unite_all(parts);
  known.cloud = sample_surface({.primitives = known.primitives, .tree = known.truth},
                               {.count = 400 * known.primitives.size(), .noise = 0.003, .seed = 3});
  return known;
}

TEST(BlockedComponent, IsRightByCells) {
  const Known known = row_of_intersections(30);
  const Extraction result = extract_csg(known.cloud, known.primitives);
  EXPECT_EQ(test::membership_iou(result.tree(), known.truth, known.primitives, 60), 1.0);
  EXPECT_LE(result.tree().size(), known.truth.size());
}

TEST(BlockedComponent, StillGivesATreeInTime) {
  const Known known = row_of_intersections(30);
  ExtractOptions options;
  options.cell_trust = test::k_never_by_cells;
  options.time_limit_seconds = 5;
  options.search.generation_limit = 3;
  const Extraction result = extract_csg(known.cloud, known.primitives, options, {.threads = 2});
  EXPECT_FALSE(primitives_of(result.tree()).empty());
  EXPECT_GT(result.statistics.merge.blocked, 0U);
  EXPECT_GE(test::membership_iou(result.tree(), known.truth, known.primitives), 0.9);
  ASSERT_EQ(result.statistics.merge.ways.size(), 1U);
}

TEST(BlockedComponent, EndsAtATimeLimitThatIsShort) {
  const Known known = row_of_intersections(30);
  const ExtractOptions options{.cell_trust = test::k_never_by_cells, .time_limit_seconds = 1e-6};
  const Extraction result = extract_csg(known.cloud, known.primitives, options);
  EXPECT_FALSE(result.statistics.complete);
  EXPECT_FALSE(primitives_of(result.tree()).empty());
}

}  // namespace
}  // namespace cloud2csg
