#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <stop_token>

#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "sample/solids.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;
using Eigen::Vector3d;

constexpr double k_degree = std::numbers::pi / 180.0;

/// Perfect but for what a test turns on; coarse meshes are enough.
ScanOptions perfect(std::size_t count = 2000) {
  ScanOptions options = without_defects({.count = count, .with_normals = true});
  options.meshing.resolution = 48;
  return options;
}

/// The square |x|, |y| <= 1 at z = 0, seen from both sides.
TriangleMesh square() {
  TriangleMesh mesh{.vertices = {}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    mesh.vertices.push_back({x, y, 0.0});
  }
  return mesh;
}

/// With corners at 1 and -1 on each axis; every sensor sees some of it.
TriangleMesh octahedron() {
  TriangleMesh mesh;
  for (const double side : {1.0, -1.0}) {
    for (int axis = 0; axis < 3; ++axis) mesh.vertices.push_back(side * Vector3d::Unit(axis));
  }
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  return mesh;
}

double diagonal(const TriangleMesh& mesh) {
  return bounds_of(mesh.vertices).diagonal().norm();
}

/// A point of the square's scan, as its sensor saw it.
struct Sighting {
  double range, true_range, cosine;
};

std::vector<Sighting> sightings(const PointCloud& scan_of_square) {
  std::vector<Sighting> all;
  for (std::size_t i = 0; i < scan_of_square.size(); ++i) {
    const Vector3d sensor = scan_of_square.sensor_positions[i];
    const Vector3d way = scan_of_square.positions[i] - sensor;
    const double cosine = std::abs(way.normalized().z());
    all.push_back({.range = way.norm(), .true_range = std::abs(sensor.z()) / cosine, .cosine = cosine});
  }
  return all;
}

TEST(Scan, PerfectPointsLieOnTheSolid) {
  std::vector<KnownSolid> solids = plain_solids();
  solids.push_back({.name = "drilled",
                    .primitives = {at("b", Box{{2, 1, 1}}, {0, 0, 0}), at("c", Cylinder{0.3, 2}, {0.2, 0, 0}),
                                   at("s", Sphere{0.6}, {-0.9, 0.4, 0.5})},
                    .tree = subtract(unite(CsgTree::leaf(0), CsgTree::leaf(2)), CsgTree::leaf(1))});
  for (const KnownSolid& solid : solids) {
    const PointCloud cloud = scan_model(solid.model(), perfect(500));
    ASSERT_EQ(cloud.size(), 500U) << solid.name;
    const double size = bounds_of(solid.model()).diagonal().norm();
    const Points gradients = implicit_gradient(solid.tree, solid.primitives, cloud.positions);
    const std::vector<double> values = implicit_value(solid.tree, solid.primitives, cloud.positions);
    std::size_t agreeing_normals = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_LT(std::abs(values[i]), 1e-6 * size) << solid.name;
      if (cloud.normals[i].dot(gradients[i].normalized()) > 0.999) ++agreeing_normals;
    }
    EXPECT_GE(agreeing_normals, cloud.size() - 2) << solid.name;  // at an edge there are two
  }
}

TEST(Scan, PerfectPointsLieOnTheMesh) {
  const PointCloud cloud = scan_mesh(square(), perfect());
  ASSERT_EQ(cloud.size(), 2000U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(std::abs(cloud.positions.z[i]), 1e-6);
    EXPECT_LE(std::max(std::abs(cloud.positions.x[i]), std::abs(cloud.positions.y[i])), 1 + 1e-6);
    EXPECT_GT(cloud.normals[i].z() * cloud.sensor_positions.z[i], 0);  // towards its sensor
  }
}

TEST(Scan, WhatIsFarFromTheOriginIsAsExact) {
  TriangleMesh mesh = square();
  for (double& z : mesh.vertices.z) z = 1e6;
  const PointCloud cloud = scan_mesh(mesh, perfect());
  ASSERT_EQ(cloud.size(), 2000U);
  for (const double z : cloud.positions.z) EXPECT_NEAR(z, 1e6, 1e-6);
}

TEST(Scan, CavitiesStayDarkAndAllThatIsOutsideIsSeen) {
  const PrimitiveSet primitives{at("b", Box{{2, 2, 2}}, {0, 0, 0}), at("s", Sphere{0.8}, {0, 0, 0})};
  const PointCloud cloud =
      scan_model({.primitives = primitives, .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))}, perfect());
  std::array<std::size_t, 6> on_face{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d position = cloud.positions[i];
    EXPECT_NEAR(position.cwiseAbs().maxCoeff(), 1.0, 1e-6);
    Eigen::Index axis = 0;
    position.cwiseAbs().maxCoeff(&axis);
    ++on_face[static_cast<std::size_t>(2 * axis + (position[axis] > 0 ? 1 : 0))];
  }
  for (const std::size_t count : on_face) EXPECT_GT(count, cloud.size() / 12);
}

TEST(Scan, NothingIsBetweenAPointAndItsSensor) {
  const PrimitiveSet primitives{at("a", Sphere{0.5}, {0, 0, 0}), at("b", Sphere{0.5}, {1.2, 0, 0}),
                                at("c", Box{{0.2, 2, 2}}, {0.6, 0, 1.2})};
  const CsgTree tree = unite(unite(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2));
  const PointCloud cloud = scan_model({.primitives = primitives, .tree = tree}, perfect());
  Points on_the_way;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (int step = 1; step < 50; ++step) {
      const double share = step / 50.0;
      on_the_way.push_back((1 - share) * cloud.positions[i] + share * cloud.sensor_positions[i]);
    }
  }
  EXPECT_GT(std::ranges::min(implicit_value(tree, primitives, on_the_way)), -1e-9);
}

TEST(Scan, SensorsStandEvenlyAroundThePart) {
  for (const std::size_t views : {std::size_t{1}, std::size_t{20}, std::size_t{100}}) {
    ScanOptions options = perfect();
    options.views = views;
    options.distance = 2.5;
    const PointCloud cloud = scan_mesh(octahedron(), options);
    std::vector<Vector3d> sensors;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vector3d sensor = cloud.sensor_positions[i];
      EXPECT_NEAR(sensor.norm(), 2.5 * std::numbers::sqrt3, 1e-9);
      if (sensors.empty() || sensors.back() != sensor) sensors.push_back(sensor);
    }
    EXPECT_EQ(sensors.size(), views);
    // The nearest two are about as far apart as the cells of an even spread are wide.
    const double width = std::sqrt(4 * std::numbers::pi / static_cast<double>(views));
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT((sensors[i].normalized() - sensors[j].normalized()).norm(), 0.7 * width);
      }
    }
  }
}

TEST(Scan, SeesNothingOfTheUndersideOnATable) {
  ScanOptions options = perfect();
  options.on_table = true;
  options.with_normals = true;
  const PointCloud cloud = scan_mesh(octahedron(), options);
  std::size_t views = 1;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_GT(cloud.sensor_positions.z[i], 0);
    EXPECT_GE(cloud.positions.z[i], -1.0);
    views += i > 0 && cloud.sensor_positions[i] != cloud.sensor_positions[i - 1] ? 1 : 0;
  }
  EXPECT_EQ(views, options.views);
  const PrimitiveSet block{{.id = "block", .shape = Box{{4, 3, 3}}}};
  EXPECT_GT(std::ranges::min(scan_model({.primitives = block, .tree = CsgTree::leaf(0)}, options).normals.z), -0.1);
}

TEST(Scan, GivesAsManyPointsAsWanted) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{7}, std::size_t{30'000}}) {
    const PointCloud cloud = scan_mesh(square(), {.count = count});
    EXPECT_EQ(cloud.size(), count);
    EXPECT_EQ(cloud.sensor_positions.size(), count);
    EXPECT_FALSE(cloud.has_normals());
  }
}

TEST(Scan, HalfTheStepGivesFourTimesThePoints) {
  ScanOptions options = perfect();
  options.angular_step_deg = 1.0;
  const auto coarse = static_cast<double>(scan_mesh(square(), options).size());
  options.angular_step_deg = 0.5;
  EXPECT_NEAR(static_cast<double>(scan_mesh(square(), options).size()) / coarse, 4.0, 0.2);
}

TEST(Scan, ANarrowFieldOfViewSeesTheMiddleOnly) {
  ScanOptions options = perfect();
  options.field_of_view_deg = 10;
  const PointCloud cloud = scan_mesh(square(), options);
  ASSERT_GT(cloud.size(), 100U);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vector3d sensor = cloud.sensor_positions[i];
    const double cosine = (cloud.positions[i] - sensor).normalized().dot(-sensor.normalized());
    EXPECT_LT(std::acos(cosine), 5 * std::numbers::sqrt2 * k_degree + 1e-9);  // a corner of the view
  }
}

/// Mean and sigma of (measured - true range) / `unit` over the sightings at these angles.
std::pair<double, double> spread(const std::vector<Sighting>& all, double least_deg, double most_deg,
                                 const std::function<double(const Sighting&)>& unit) {
  double sum = 0, squares = 0, count = 0;
  for (const Sighting& sighting : all) {
    const double angle = std::acos(sighting.cosine) / k_degree;
    if (angle < least_deg || angle > most_deg) continue;
    const double error = (sighting.range - sighting.true_range) / unit(sighting);
    sum += error, squares += error * error, ++count;
  }
  EXPECT_GT(count, 500) << least_deg;
  return {sum / count, std::sqrt(squares / count)};
}

TEST(Scan, NoiseIsAsWantedAtAnyIncidence) {
  ScanOptions options = perfect(40'000);
  options.noise = 1e-4;
  const std::vector<Sighting> all = sightings(scan_mesh(square(), options));
  const double sigma = 1e-4 * diagonal(square());
  const double reference = options.distance * 0.5 * diagonal(square());
  for (const auto& [least, most] : {std::pair{0.0, 15.0}, {55.0, 65.0}, {0.0, 85.0}}) {
    const auto [mean, deviation] = spread(all, least, most, [&](const Sighting& sighting) {
      return sigma * std::pow(sighting.true_range / reference, 2) / sighting.cosine;
    });
    EXPECT_NEAR(deviation, 1.0, 0.05) << least;
    EXPECT_NEAR(mean, 0.0, 0.1) << least;
  }
  const auto flat = [&](const Sighting& /*sighting*/) { return sigma; };
  EXPECT_NEAR(spread(all, 0, 15, flat).second, 1.0, 0.15);
  EXPECT_NEAR(spread(all, 57, 63, flat).second, 2.0, 0.3);
}

TEST(Scan, RangesAreMultiplesOfTheQuantum) {
  ScanOptions options = perfect();
  options.noise = 1e-3;
  options.quantisation = 0.01;
  for (const Sighting& sighting : sightings(scan_mesh(square(), options))) {
    const double steps = sighting.range / (0.01 * diagonal(square()));
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST(Scan, ReturnsThinOutAtGrazingIncidence) {
  ScanOptions options = perfect();
  options.angular_step_deg = 0.25;
  const std::vector<Sighting> all = sightings(scan_mesh(square(), options));
  options.grazing_angle_deg = 60;
  options.grazing_loss = 0.8;
  const std::vector<Sighting> left = sightings(scan_mesh(square(), options));
  const auto between = [](const std::vector<Sighting>& some, double least, double most) {
    return static_cast<double>(std::ranges::count_if(some, [&](const Sighting& sighting) {
      const double angle = std::acos(sighting.cosine) / k_degree;
      return angle >= least && angle < most;
    }));
  };
  EXPECT_EQ(between(left, 0, 60), between(all, 0, 60));
  EXPECT_NEAR(between(left, 60, 70) / between(all, 60, 70), 1 - 0.8 / 6, 0.04);
  EXPECT_NEAR(between(left, 75, 85) / between(all, 75, 85), 1 - 0.8 * 4 / 6, 0.05);
}

TEST(Scan, OutliersAreAsManyAsWantedOnTheirRaysWithinTheSphere) {
  ScanOptions options = perfect(20'000);
  options.outliers = 0.1;
  const PointCloud cloud = scan_mesh(square(), options);
  std::size_t outliers = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(cloud.positions.z[i]) > 1e-9) ++outliers;
    EXPECT_LT(cloud.positions[i].norm(), std::numbers::sqrt2 + 1e-9);
  }
  EXPECT_NEAR(static_cast<double>(outliers), 2000, 4 * std::sqrt(2000 * 0.9));
}

TEST(Scan, MixedPixelsLieBetweenTwoSurfacesAtEdgesOnly) {
  // Two plates, one over the middle of the other.
  const PrimitiveSet primitives{at("low", Box{{4, 4, 0.2}}, {0, 0, 0}), at("high", Box{{1, 1, 0.2}}, {0, 0, 1.5})};
  const CsgTree tree = unite(CsgTree::leaf(0), CsgTree::leaf(1));
  ScanOptions options = perfect(20'000);
  options.mixed_pixels = 1.0;
  const PointCloud cloud = scan_model({.primitives = primitives, .tree = tree}, options);
  const std::vector<double> values = implicit_value(tree, primitives, cloud.positions);
  std::size_t mixed = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (values[i] < 1e-3) continue;  // on a surface, or in the part behind a facet's edge
    ++mixed;
    // The ray goes by the upper plate, or the lower one, within the width of a beam.
    const Vector3d sensor = cloud.sensor_positions[i];
    const Vector3d way = cloud.positions[i] - sensor;
    Points on_ray;
    for (int step = 0; step < 2000; ++step) on_ray.push_back(sensor + 2e-3 * step * way);
    const std::vector<double> along = implicit_value(tree, primitives, on_ray);
    const auto own = static_cast<std::ptrdiff_t>(500);
    EXPECT_LT(*std::min_element(along.begin() + own, along.end()), 0.1);
    EXPECT_LT(std::abs(cloud.positions.z[i]), 1.7);
  }
  EXPECT_GT(mixed, 20U);
  EXPECT_LT(mixed, cloud.size() / 10);
}

TEST(Scan, MisregistrationMovesEachViewAsAWhole) {
  ScanOptions options = perfect();
  options.angular_step_deg = 1.0;
  const PointCloud truth = scan_mesh(square(), options);
  options.rotation_deg = 1.0;
  options.translation = 0.01;
  const PointCloud moved = scan_mesh(square(), options);
  ASSERT_EQ(moved.size(), truth.size());
  std::map<std::size_t, std::size_t> view_start;  // first point to one past the last
  for (std::size_t begin = 0, i = 1; i <= truth.size(); ++i) {
    if (i < truth.size() && truth.sensor_positions[i] == truth.sensor_positions[begin]) continue;
    view_start[begin] = i;
    begin = i;
  }
  EXPECT_EQ(view_start.size(), options.views);
  double squares = 0;
  for (const auto& [begin, end] : view_start) {
    const auto length = [begin = begin](const PointCloud& cloud, std::size_t i) {
      return (cloud.positions[i] - cloud.positions[begin]).norm();
    };
    for (std::size_t i = begin; i < end; ++i) {
      EXPECT_NEAR(length(moved, i), length(truth, i), 1e-9);
      EXPECT_NEAR((moved.positions[i] - moved.sensor_positions[i]).norm(),
                  (truth.positions[i] - truth.sensor_positions[i]).norm(), 1e-9);
      EXPECT_NEAR(moved.normals[i].dot(moved.positions[begin] - moved.positions[i]), 0.0, 1e-9);
    }
    squares += (moved.positions[begin] - truth.positions[begin]).squaredNorm();
  }
  // Of the shift alone: three coordinates of 0.01 diagonals each; the turn adds up to about as much.
  const double moves = std::sqrt(squares / static_cast<double>(options.views)) / diagonal(square());
  EXPECT_GT(moves, 0.01);
  EXPECT_LT(moves, 0.04);
}

TEST(Scan, IsTheSameForAnyNumberOfThreadsAndAnotherForAnotherSeed) {
  const KnownSolid torus = plain_solids().at(5);
  ScanOptions options{.count = 20'000};
  options.meshing.resolution = 48;
  const PointCloud one = scan_model(torus.model(), options, {.threads = 1});
  const PointCloud two = scan_model(torus.model(), options, {.threads = 2});
  EXPECT_EQ(one.positions.x, two.positions.x);
  EXPECT_EQ(one.positions.y, two.positions.y);
  EXPECT_EQ(one.positions.z, two.positions.z);
  EXPECT_EQ(one.sensor_positions.x, two.sensor_positions.x);
  options.seed = 2;
  EXPECT_NE(scan_model(torus.model(), options).positions.x, one.positions.x);
}

TEST(Scan, RefusesOptionsOutOfRangeByName) {
  const auto refused = [](const char* name, const std::function<void(ScanOptions&)>& spoil) {
    ScanOptions options;
    spoil(options);
    try {
      (void)scan_mesh(square(), options);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().where, name);
    }
  };
  refused("views", [](ScanOptions& options) { options.views = 0; });
  refused("distance", [](ScanOptions& options) { options.distance = 1.0; });
  refused("field_of_view_deg", [](ScanOptions& options) { options.field_of_view_deg = 180; });
  refused("count", [](ScanOptions& options) { options.count = 0; });
  refused("angular_step_deg", [](ScanOptions& options) { options.angular_step_deg = -1; });
  refused("angular_step_deg", [](ScanOptions& options) { options.angular_step_deg = 1e-9; });
  refused("noise", [](ScanOptions& options) { options.noise = NAN; });
  refused("quantisation", [](ScanOptions& options) { options.quantisation = -1; });
  refused("grazing_angle_deg", [](ScanOptions& options) { options.grazing_angle_deg = 90; });
  refused("grazing_loss", [](ScanOptions& options) { options.grazing_loss = 1.5; });
  refused("outliers", [](ScanOptions& options) { options.outliers = -0.1; });
  refused("mixed_pixels", [](ScanOptions& options) { options.mixed_pixels = 2; });
  refused("rotation_deg", [](ScanOptions& options) { options.rotation_deg = INFINITY; });
  refused("translation", [](ScanOptions& options) { options.translation = -1; });
}

TEST(Scan, RefusesWhatCannotBeSeen) {
  EXPECT_THROW((void)scan_mesh({}), Error);
  EXPECT_THROW((void)scan_mesh({.vertices = Points(3), .triangles = {{0, 1, 2}}}), Error);  // no area
  const PrimitiveSet primitives{at("h", HalfSpace{}, {0, 0, 0}), at("s", Sphere{1}, {0, 0, 0})};
  EXPECT_THROW((void)scan_model({.primitives = primitives, .tree = CsgTree::leaf(0)}), Error);
  EXPECT_THROW((void)scan_model({.primitives = primitives, .tree = subtract(CsgTree::leaf(1), CsgTree::leaf(1))}),
               Error);
}

TEST(Scan, StopsAndReports) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)scan_mesh(square(), {}, {.stop = stop.get_token()}), Cancelled);
  Progress last;
  (void)scan_mesh(square(), perfect(), {.on_progress = [&last](const Progress& progress) { last = progress; }});
  EXPECT_EQ(last.stage, "scan");
  EXPECT_EQ(last.done, 20U);
  EXPECT_EQ(last.total, 20U);
}

}  // namespace
}  // namespace cloud2csg
