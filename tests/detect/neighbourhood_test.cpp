#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raw/detect/grow.hpp"
#include "raw/detect/work_cloud.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

std::vector<OrientedPoint> random_points(std::size_t count, RandomStream& random) {
  std::vector<OrientedPoint> points(count);
  for (OrientedPoint& p : points) p = {.position = test::random_within(1, random), .normal = {0, 0, 1}};
  return points;
}

/// Groups by trying all pairs until nothing changes.
std::vector<std::uint32_t> plain_groups(const std::vector<OrientedPoint>& points, double edge) {
  std::vector<std::uint32_t> group(points.size());
  std::iota(group.begin(), group.end(), 0U);
  const auto touch = [&](std::size_t a, std::size_t b) {
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = std::floor(points[a].position[axis] / edge) - std::floor(points[b].position[axis] / edge);
      if (std::abs(steps) > 1) return false;
    }
    return true;
  };
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (group[a] == group[b] || !touch(a, b)) continue;
      const auto [low, high] = std::pair(std::min(group[a], group[b]), std::max(group[a], group[b]));
      std::replace(group.begin(), group.end(), high, low);
    }
  }
  return group;
}

RC_GTEST_PROP(ConnectedGroups, AreThoseOfAllPairs, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  const std::vector<OrientedPoint> points = random_points(60, random);
  const double edge = random.uniform(0.1, 0.6);
  std::vector<std::uint32_t> indices(points.size());
  std::iota(indices.begin(), indices.end(), 0U);
  const auto groups = connected_groups(points, indices, edge);
  const std::vector<std::uint32_t> plain = plain_groups(points, edge);

  std::size_t total = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    total += groups[g].size();
    RC_ASSERT(std::is_sorted(groups[g].begin(), groups[g].end()));
    // Not in one assertion: those of RapidCheck look at both sides of an "or".
    if (g > 0) RC_ASSERT(groups[g].size() <= groups[g - 1].size());
    for (const std::uint32_t i : groups[g]) RC_ASSERT(plain[i] == plain[groups[g][0]]);
    RC_ASSERT(static_cast<std::size_t>(std::count(plain.begin(), plain.end(), plain[groups[g][0]])) ==
              groups[g].size());
  }
  RC_ASSERT(total == points.size());
}

RC_GTEST_PROP(WorkCloud, KeepsCellsTogether, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint32_t>());
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    cloud.positions.push_back(7 * test::random_within(1, random) + Eigen::Vector3d(100, 0, -50));
    cloud.normals.push_back(test::random_direction(random));
  }
  const WorkCloud work = make_work_cloud(cloud);
  for (std::uint32_t i = 0; i < work.size(); ++i) {
    const Eigen::Vector3d back = work.points[i].position * work.diagonal + work.middle;
    RC_ASSERT((back - cloud.positions[work.index[i]]).norm() < 1e-9);
    RC_ASSERT(work.points[i].normal == cloud.normals[work.index[i]]);
  }
  const auto i = random.below(work.size());
  const int level = static_cast<int>(random.below(WorkCloud::k_levels + 1));
  const auto [first, last] = work.cell_of(i, level);
  const std::uint32_t shift = 3 * static_cast<std::uint32_t>(WorkCloud::k_levels - level);
  for (std::uint32_t j = 0; j < work.size(); ++j) {
    const bool is_inside = j >= first && j < last;
    RC_ASSERT(is_inside == (work.code[j] >> shift == work.code[i] >> shift));
  }
}

}  // namespace
}  // namespace cloud2csg
