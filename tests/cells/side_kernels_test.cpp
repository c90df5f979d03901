#include "cells/side_kernels.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "support/field_block.hpp"
#include "support/forced_target.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

template <class Real>
using Block = test::FieldBlock<Real>;

/// Of distances many are zero, of either sign, and many just at the limits; of gradients some are zero or across.
template <class Real>
Block<Real> random_block(const SegmentationTolerances& tolerances, RandomStream& random) {
  Block<Real> block;
  const std::array<double, 4> limits{0.0, -0.0, tolerances.distance, tolerances.distance * k_open_share};
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const double sign = random.chance(0.5) ? 1 : -1;
    const double distance =
        random.chance(0.5) ? limits[random.below(limits.size())] : random.uniform(0, 2) * tolerances.distance;
    block.field.distance[i] = static_cast<Real>(sign * distance);
    const Eigen::Vector3d normal =
        random.chance(0.3) ? Eigen::Vector3d(Eigen::Vector3d::Unit(random.below(3))) : test::random_direction(random);
    const Eigen::Vector3d slope = random.chance(0.3) ? Eigen::Vector3d(Eigen::Vector3d::Unit(random.below(3)))
                                                     : normal + test::random_within(0.8, random);
    const double length = random.chance(0.1) ? 0.0 : std::exp(random.uniform(-8, 8));
    block.set_normal(i, normal);
    block.set_gradient(i, (random.chance(0.5) ? length : -length) * slope);
  }
  return block;
}

/// Point by point, in the kernel's order of operations.
template <class Real>
BlockSides plain_sides(const Block<Real>& block, const SegmentationTolerances& tolerances) {
  BlockSides sides;
  const auto& [f, gx, gy, gz] = block.field;
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const Real nx = block.normal_columns[0].values[i];
    const Real ny = block.normal_columns[1].values[i];
    const Real nz = block.normal_columns[2].values[i];
    const Real dot = gx[i] * nx + gy[i] * ny + gz[i] * nz;
    const Real square = gx[i] * gx[i] + gy[i] * gy[i] + gz[i] * gz[i];
    const bool is_near = std::abs(f[i]) <= static_cast<Real>(tolerances.distance);
    const bool agrees = dot * dot >= static_cast<Real>(tolerances.cosine * tolerances.cosine) * square && square > 0;
    if (f[i] < 0) add_point(sides.inside, i);
    if (is_near) add_point(sides.near, i);
    if (std::abs(f[i]) <= static_cast<Real>(tolerances.distance * k_open_share)) add_point(sides.open, i);
    if (is_near && agrees && dot > 0) add_point(sides.along, i);
    if (is_near && agrees && dot < 0) add_point(sides.against, i);
  }
  return sides;
}

template <class Real>
void expect_plain_sides(std::uint64_t seed) {
  RandomStream random(seed);
  const SegmentationTolerances tolerances{.distance = random.uniform(0.01, 1),
                                          .cosine = random.chance(0.1) ? 0.0 : random.uniform(0, 1)};
  const Block<Real> block = random_block<Real>(tolerances, random);
  const BlockSides expected = plain_sides(block, tolerances);
  for (const std::int64_t target : test::all_targets()) {
    const test::ForcedTarget forced(target);
    BlockSides sides;
    sides.inside.fill(~std::uint64_t{0});  // what was there before does not matter
    compute_sides(block.field, block.normals(), tolerances, sides);
    const bool same = sides.inside == expected.inside && sides.near == expected.near && sides.open == expected.open &&
                      sides.along == expected.along && sides.against == expected.against;
    if (!same) RC_FAIL(std::string(hwy::TargetName(target)));
  }
}

RC_GTEST_PROP(SideKernels, AreThePlainLoopOnEveryInstructionSet, (std::uint64_t seed)) {
  expect_plain_sides<double>(seed);
  expect_plain_sides<float>(seed);
}

/// Whichever way the normal points, and however long the gradient is.
TEST(SideKernels, TellAlongFromAgainst) {
  Block<double> block;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d tilted = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()) * up;
  const std::array<std::pair<Eigen::Vector3d, Eigen::Vector3d>, 5> cases{
      {{up, 3 * tilted}, {-up, 3 * tilted}, {up, Eigen::Vector3d::Zero()}, {up, Eigen::Vector3d::UnitX()}, {up, -up}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    block.set_normal(i, cases[i].first);
    block.set_gradient(i, cases[i].second);
  }
  BlockSides sides;
  compute_sides(block.field, block.normals(), {.distance = 0.1, .cosine = std::cos(0.5)}, sides);
  EXPECT_EQ(sides.along, (BlockMask{0b00001}));
  EXPECT_EQ(sides.against, (BlockMask{0b10010}));
  EXPECT_EQ(sides.inside, BlockMask{});
}

}  // namespace
}  // namespace cloud2csg
