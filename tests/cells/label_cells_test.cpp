#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud2csg/advanced/cells.hpp"
#include "core/base/random.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using Labels = std::vector<bool>;

/// Some patches without points, some without area, some that contradict themselves.
CellComplex random_complex(RandomStream& random) {
  const std::size_t cells = 2 + random.below(9);
  CellComplex complex;
  for (std::size_t c = 0; c < cells; ++c) complex.cells.push_back(c == 0 ? Cell{} : Cell{static_cast<CellIndex>(c)});
  const auto some = [&random](double chance, std::size_t most) {
    return random.chance(chance) ? 0.25 * (1 + random.below(4 * most)) : 0.0;
  };
  const double density = random.uniform(0.5, 4);
  for (CellIndex first = 0; first < cells; ++first) {
    for (CellIndex second = first + 1; second < cells; ++second) {
      if (random.chance(0.5)) continue;
      Patch patch{.first = first, .second = second, .first_in = some(0.4, 10), .second_in = some(0.4, 10)};
      patch.area = random.chance(0.8) ? (patch.first_in + patch.second_in + some(0.3, 20)) / density : 0.0;
      complex.patches.push_back(patch);
    }
  }
  complex.points_of_primitive.resize(cells);
  for (std::size_t c = 0; random.chance(0.9) && c < cells; ++c) complex.seen_through.push_back(some(0.5, 5));
  if (!complex.seen_through.empty()) complex.seen_through.resize(cells);
  return complex;
}

/// What the header says, patch by patch.
double plain_cost(const CellComplex& complex, const Labels& is_in, double density, const LabelOptions& options) {
  double cost = 0;
  for (const Patch& patch : complex.patches) {
    const bool first = is_in[patch.first];
    const bool second = is_in[patch.second];
    cost += patch.first_in * ((first ? 0 : 0.5) + (second ? 0.5 : 0));
    cost += patch.second_in * ((second ? 0 : 0.5) + (first ? 0.5 : 0));
    const double seen = options.presence * (patch.first_in + patch.second_in);
    if (first != second) cost += std::max(0.0, options.absence * density * patch.area - seen);
  }
  for (std::size_t cell = 0; cell < complex.seen_through.size(); ++cell) {
    if (is_in[cell]) cost += options.sight * complex.seen_through[cell];
  }
  return cost;
}

double least_cost(const CellComplex& complex, double density, const LabelOptions& options) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t code = 0; code < std::size_t{1} << complex.cells.size(); code += 2) {  // the first cell is out
    Labels is_in(complex.cells.size());
    for (std::size_t c = 0; c < is_in.size(); ++c) is_in[c] = (code >> c & 1U) != 0;
    least = std::min(least, plain_cost(complex, is_in, density, options));
  }
  return least;
}

RC_GTEST_PROP(LabelCells, CostsTheLeastOfAllLabels, (std::uint64_t seed)) {
  RandomStream random(seed);
  const CellComplex complex = random_complex(random);
  const LabelOptions options{.absence = random.chance(0.5) ? 0.5 : random.uniform(),
                             .presence = random.chance(0.5) ? 1.0 : random.uniform(0, 10),
                             .sight = random.uniform(0, 2)};
  const CellLabels labels = label_cells(complex, options);
  RC_ASSERT(!labels.is_in.front());
  const double cost = plain_cost(complex, labels.is_in, labels.density, options);
  RC_ASSERT(std::abs(cost - least_cost(complex, labels.density, options)) < 1e-9);
  RC_ASSERT(std::abs(cost - labels.cost) < 1e-9);
}

RC_GTEST_PROP(LabelCells, CostOfAnyLabelsIsThatOfThePatches, (std::uint64_t seed)) {
  RandomStream random(seed);
  const CellComplex complex = random_complex(random);
  Labels is_in(complex.cells.size());
  for (std::size_t c = 0; c < is_in.size(); ++c) is_in[c] = random.chance(0.5);
  const double density = random.uniform(0, 5);
  RC_ASSERT(std::abs(cost_of(complex, is_in, density) - plain_cost(complex, is_in, density, {})) < 1e-9);
}

RC_GTEST_PROP(LabelCells, EvidenceIsWhatAChangeOfOneLabelCosts, (std::uint64_t seed)) {
  RandomStream random(seed);
  const CellComplex complex = random_complex(random);
  const CellLabels labels = label_cells(complex);
  RC_ASSERT(labels.evidence.size() == complex.cells.size());
  RC_ASSERT(std::isinf(labels.evidence.front()));
  for (std::size_t c = 1; c < complex.cells.size(); ++c) {
    Labels changed = labels.is_in;
    changed[c] = !changed[c];
    const double more = cost_of(complex, changed, labels.density) - labels.cost;
    RC_ASSERT(labels.evidence[c] >= 0);
    RC_ASSERT(std::abs(labels.evidence[c] - std::max(0.0, more)) < 1e-9);
  }
}

RC_GTEST_PROP(LabelCells, CountsThePointsThatSpeak, (std::uint64_t seed)) {
  RandomStream random(seed);
  const CellComplex complex = random_complex(random);
  double points = 0;
  for (const Patch& patch : complex.patches) points += patch.first_in + patch.second_in;
  RC_ASSERT(label_cells(complex).points == points);
}

/// Patches that are no surface, and have but a few points astray, do not lower it.
TEST(Density, IsThatWherePointsAreSparse) {
  const CellComplex complex{.cells = {{}, {0}, {1}, {2}},
                            .patches = {{.first = 0, .second = 1, .first_in = 0, .second_in = 100, .area = 10},
                                        {.first = 0, .second = 2, .first_in = 0, .second_in = 190, .area = 20},
                                        {.first = 0, .second = 3, .first_in = 0, .second_in = 20, .area = 1},
                                        {.first = 1, .second = 2, .first_in = 3, .second_in = 0, .area = 50},
                                        {.first = 1, .second = 3, .first_in = 0, .second_in = 0, .area = 50}},
                            .points_of_primitive = {100, 190, 20},
                            .order = {}};
  EXPECT_DOUBLE_EQ(label_cells(complex).density, 9.5);
}

/// Nobody saw anything: nothing is in the solid, and nothing costs.
TEST(LabelCells, OfNoPointsAreOut) {
  const CellComplex complex{.cells = {{}, {0}}, .patches = {}, .points_of_primitive = {0}, .order = {}};
  const CellLabels labels = label_cells(complex);
  EXPECT_EQ(labels.is_in, Labels(2, false));
  EXPECT_EQ(labels.cost, 0.0);
  EXPECT_EQ(labels.density, 0.0);
}

/// Whether a cell is in the solid, by the points of a cloud.
class LabelsOfPoints : public ::testing::Test {
 protected:
  void take(const PointCloud& cloud) {
    complex_ = find_cells(cloud, primitives_, {.tolerances = segmentation_tolerances({}, 0.002), .noise = 0.002});
    labels_ = label_cells(complex_);
  }
  [[nodiscard]] PointCloud cloud_of(const char* formula) const {
    return sample_surface({.primitives = primitives_, .tree = parse_tree(formula, primitives_)},
                          {.count = 4000, .noise = 0.002, .seed = 3});
  }
  [[nodiscard]] std::size_t index_of(const Cell& cell) const {
    const auto found = std::ranges::lower_bound(complex_.cells, cell);
    EXPECT_TRUE(found != complex_.cells.end() && *found == cell);
    return static_cast<std::size_t>(found - complex_.cells.begin());
  }
  [[nodiscard]] bool is_in(const Cell& cell) const { return labels_.is_in[index_of(cell)]; }
  [[nodiscard]] double evidence(const Cell& cell) const { return labels_.evidence[index_of(cell)]; }

  const PrimitiveSet primitives_{test::placed("a", Box{{2, 2, 2}}, {0, 0, 0}),
                                 test::placed("b", Sphere{0.6}, {0.1, 0, 0}),
                                 test::placed("c", Box{{1, 1, 1}}, {1, 0, 0})};
  CellComplex complex_;
  CellLabels labels_;
};

/// That there are no points on a surface says that it is none.
TEST_F(LabelsOfPoints, CoverWhatNoPointSees) {
  take(cloud_of("a | c"));
  for (const Cell& cell : std::vector<Cell>{{0}, {2}, {0, 1}, {0, 2}, {0, 1, 2}}) {
    EXPECT_TRUE(is_in(cell));
    EXPECT_GT(evidence(cell), 10.0);
  }
  take(cloud_of("a - c"));
  for (const Cell& cell : std::vector<Cell>{{0, 2}, {0, 1, 2}, {2}}) EXPECT_FALSE(is_in(cell));
  EXPECT_TRUE(is_in({0, 1}));
}

TEST_F(LabelsOfPoints, SeeAHole) {
  take(cloud_of("a - b"));
  EXPECT_TRUE(is_in({0}));
  EXPECT_TRUE(is_in({0, 2}));
  EXPECT_FALSE(is_in({0, 1}));
  EXPECT_FALSE(is_in({0, 1, 2}));
  EXPECT_FALSE(is_in({2}));
  EXPECT_LT(labels_.cost, 0.02 * labels_.points);
}

/// A scan that has seen nothing from below.
TEST_F(LabelsOfPoints, DoWithoutASideThatWasNotSeen) {
  const PointCloud whole = cloud_of("(a | c) - b");
  PointCloud seen;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole.normals[i].z() < -0.9 && whole.positions[i].z() < -0.9) continue;
    seen.positions.push_back(whole.positions[i]);
    seen.normals.push_back(whole.normals[i]);
  }
  ASSERT_LT(seen.size() + 300, whole.size());
  take(whole);
  const CellComplex complex = complex_;
  const CellLabels expected = labels_;
  take(seen);
  ASSERT_EQ(complex_.cells, complex.cells);
  EXPECT_EQ(labels_.is_in, expected.is_in);
  EXPECT_TRUE(is_in({0}));
}

}  // namespace
}  // namespace cloud2csg
