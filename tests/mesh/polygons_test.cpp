#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "mesh/read_bytes.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;
using shapes::area_of;
using shapes::area_vector;
using shapes::read_bytes;

/// A polygon around the origin of the plane z = 0, turned to any direction: a star, which is not convex.
TEST(ReadMesh, CutsPolygonsThatAreNotConvexWithoutOverlap) {
  rc::check([] {
    const auto count = *rc::gen::inRange<std::size_t>(4, 40);
    const auto radii = *rc::gen::container<std::vector<double>>(
        count, rc::gen::map(rc::gen::inRange(20, 100), [](int percent) { return percent / 100.0; }));
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(*rc::gen::inRange(0, 7), Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(*rc::gen::inRange(0, 7), Vector3d::UnitY());
    std::string points;
    std::string face = std::to_string(count);
    double area = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const double step = 2.0 * std::numbers::pi / static_cast<double>(count);
      const double angle = static_cast<double>(i) * step;
      const Vector3d p = turn * (radii[i] * Vector3d(std::cos(angle), std::sin(angle), 0.0));
      points += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
      face += " " + std::to_string(i);
      area += 0.5 * radii[i] * radii[(i + 1) % count] * std::sin(step);
    }
    const TriangleMesh mesh = read_bytes("star.off", fmt::format("OFF\n{} 1 0\n{}{}\n", count, points, face));
    RC_ASSERT(std::abs(area_of(mesh) - area) < 1e-9);
    RC_ASSERT((area_vector(mesh) - area * (turn * Vector3d::UnitZ())).norm() < 1e-9);
  });
}

TEST(ReadMesh, CutsAPolygonWithThousandsOfTeethAndLargeConvexOnes) {
  const auto polygon = [](std::size_t count, double inner) {
    std::string text = fmt::format("OFF\n{} 1 0\n", count);
    std::string face = std::to_string(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
      const double radius = i % 4 < 2 ? 1.0 : inner;
      text += fmt::format("{} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
      face += " " + std::to_string(i);
    }
    return read_bytes("polygon.off", text + face + "\n");
  };
  const TriangleMesh cogwheel = polygon(4000, 0.9);
  EXPECT_EQ(cogwheel.triangles.size(), 3998U);
  EXPECT_NEAR(area_of(cogwheel), area_vector(cogwheel).norm(), 1e-9);
  EXPECT_EQ(polygon(500'000, 1.0).triangles.size(), 499'998U);
}

TEST(ReadMesh, TakesPolygonsThatAreNotSimple) {
  for (const char* face : {"4 0 0 0 1", "4 0 1 0 1", "5 0 1 2 0 1", "6 3 2 1 0 1 2", "4 0 2 1 3"}) {
    const std::string text = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n" + std::string(face) + "\n";
    EXPECT_GE(read_bytes("a.off", text).triangles.size(), 1U) << face;
  }
}

}  // namespace
}  // namespace cloud2csg
