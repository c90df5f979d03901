#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.hpp"
#include "shape/sample/ray_caster.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

Vector3d random_point(RandomStream& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

/// The smallest distance to points all over the triangle: an upper bound.
double searched_distance(const Triangle& triangle, const Vector3d& point) {
  constexpr int k_steps = 100;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= k_steps; ++i) {
    for (int j = 0; i + j <= k_steps; ++j) {
      const double a = static_cast<double>(i) / k_steps;
      const double b = static_cast<double>(j) / k_steps;
      best = std::min(best, (a * triangle[0] + b * triangle[1] + (1 - a - b) * triangle[2] - point).norm());
    }
  }
  return best;
}

double distance_to(const Triangle& triangle, const Vector3d& point) {
  TriangleMesh mesh{.vertices = {}, .triangles = {{0, 1, 2}}};
  for (const Vector3d& corner : triangle) mesh.vertices.push_back(corner);
  return RayCaster(mesh).distance(point);
}

RC_GTEST_PROP(MeshDistance, IsThatToTheNearestOfManyPoints, (std::uint64_t seed)) {
  RandomStream random(seed);
  Triangle triangle{random_point(random), random_point(random), random_point(random)};
  if (random.chance(0.2)) triangle[2] = 0.5 * (triangle[0] + triangle[1]);
  if (random.chance(0.1)) triangle[1] = triangle[0];
  const Vector3d point = random_point(random);
  const double distance = distance_to(triangle, point);
  const double searched = searched_distance(triangle, point);
  RC_ASSERT(distance <= searched + 1e-12);
  RC_ASSERT(distance >= searched - 0.03);
}

RC_GTEST_PROP(MeshDistance, FindsTheNearestOfAllTriangles, (std::uint64_t seed)) {
  RandomStream random(seed);
  TriangleMesh mesh;
  const auto count = *rc::gen::inRange<std::uint32_t>(1, 60);
  for (std::uint32_t t = 0; t < count; ++t) {
    const Vector3d corner = 3 * random_point(random);
    for (int i = 0; i < 3; ++i) mesh.vertices.push_back(corner + random_point(random));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  const RayCaster caster(mesh);
  for (int query = 0; query < 10; ++query) {
    // From within the mesh to so far off that all of it is one point in single precision.
    const Vector3d point = 4 * std::pow(10, random.uniform(0, 9)) * random_point(random);
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.triangles) {
      best = std::min(best, distance_to({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, point));
    }
    RC_ASSERT(caster.distance(point) == best);
  }
}

TEST(MeshDistance, OfNoTrianglesIsInfinite) {
  EXPECT_EQ(RayCaster(TriangleMesh{}).distance({0, 0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace cloud2csg
