#include "detection/household.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cloud2csg/mesh.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_household_stage = 0x686f75;
constexpr double k_noise = 0.004;  // before smoothing; 1 mm on a thing of 25 cm, as of a depth camera
constexpr double k_lid = 5 * k_noise;
constexpr double k_radius = 0.3;
constexpr double k_rim = 0.08;  // width and depth: eight vertices, of which smoothing leaves half flat
constexpr double k_wall = 10 * k_noise;

/// Faces to -x, +x, -y, +y, -z, +z.
std::vector<Surface> faces_of_box(const Vector3d& low, const Vector3d& high) {
  std::vector<Surface> faces;
  for (int axis = 0; axis < 3; ++axis) {
    faces.push_back({.position = low, .axis = -Vector3d::Unit(axis)});
    faces.push_back({.position = high, .axis = Vector3d::Unit(axis)});
  }
  return faces;
}

Surface upward(double height) {
  return {.position = height * Vector3d::UnitZ()};
}

Surface downward(double height) {
  return {.position = height * Vector3d::UnitZ(), .axis = -Vector3d::UnitZ()};
}

Surface round(double radius, bool concave) {
  return {.type = SurfaceType::cylinder, .radius = radius, .concave = concave};
}

HouseholdThing plain_box() {
  const Vector3d size(1, 0.7, 0.25);
  return {.name = "box",
          .model = parse_openscad(fmt::format("cube([{}, {}, {}]);", size.x(), size.y(), size.z())),
          .surfaces = faces_of_box(Vector3d::Zero(), size),
          .questions = {{"end", {.surfaces = {0, 5}}, size.x() / k_noise},
                        {"side", {.surfaces = {2, 5}}, size.y() / k_noise},
                        {"top", {.surfaces = {5, 4}}, size.z() / k_noise}}};
}

HouseholdThing box_with_lid() {
  const Vector3d body(1, 0.6, 0.35);
  const Vector3d low(-k_lid, -k_lid, 0.28);
  const Vector3d high(body.x() + k_lid, body.y() + k_lid, 0.4);
  const Vector3d lid = high - low;
  std::vector<Surface> surfaces = faces_of_box(low, high);
  const std::vector<Surface> below = faces_of_box(Vector3d::Zero(), body);
  surfaces.insert(surfaces.end(), below.begin(), below.end() - 1);  // the lid hides the body's top
  return {
      .name = "box with a lid",
      .model = parse_openscad(fmt::format("cube([{}, {}, {}]); translate([{}, {}, {}]) cube([{}, {}, {}]);", body.x(),
                                          body.y(), body.z(), low.x(), low.y(), low.z(), lid.x(), lid.y(), lid.z())),
      .surfaces = std::move(surfaces),
      .questions = {{"side of the lid", {.surfaces = {2, 8}}, k_lid / k_noise},
                    {"end of the lid", {.surfaces = {0, 6}}, k_lid / k_noise},
                    {"top", {.surfaces = {5, 10}}, high.z() / k_noise}}};
}

HouseholdThing plain_can() {
  return {.name = "can",
          .model = parse_openscad(fmt::format("cylinder(r = {}, h = 1);", k_radius)),
          .surfaces = {round(k_radius, false), upward(1), downward(0)},
          .questions = {{"wall", {.surfaces = {0, 1}}, k_radius / k_noise},
                        {"both ends", {.surfaces = {1, 2}}, 1 / k_noise}}};
}

HouseholdThing can_with_rim() {
  const double inner = k_radius - k_rim;
  return {.name = "can with a rim",
          .model = parse_openscad(
              fmt::format("difference() {{ cylinder(r = {}, h = 1); translate([0, 0, {}]) cylinder(r = {}, h = 1); }}",
                          k_radius, 1 - k_rim, inner)),
          .surfaces = {round(k_radius, false), round(inner, true), upward(1), upward(1 - k_rim), downward(0)},
          .questions = {{"wall", {.surfaces = {0, 4}}, k_radius / k_noise},
                        {"inside of the rim", {.surfaces = {1, 3}}, inner / k_noise},
                        {"lid and rim", {.surfaces = {3, 2}}, k_rim / k_noise}}};
}

HouseholdThing open_can() {
  const double inner = k_radius - k_wall;
  return {.name = "open can",
          .model = parse_openscad(
              fmt::format("difference() {{ cylinder(r = {}, h = 1); translate([0, 0, {}]) cylinder(r = {}, h = 1); }}",
                          k_radius, k_wall, inner)),
          .surfaces = {round(k_radius, false), round(inner, true), upward(1), upward(k_wall), downward(0)},
          .questions = {{"outside of the wall", {.surfaces = {0, 4}}, k_radius / k_noise},
                        {"inside of the wall", {.surfaces = {1, 3}}, inner / k_noise},
                        {"both sides of the bottom", {.surfaces = {3, 4}}, k_wall / k_noise}}};
}

std::uint32_t nearest_surface(const std::vector<Surface>& surfaces, const Vector3d& place) {
  const auto distance = [&](const Surface& surface) { return std::abs(signed_distance(surface, place)); };
  return static_cast<std::uint32_t>(std::ranges::min_element(surfaces, {}, distance) - surfaces.begin());
}

/// Moves each vertex half of the way to the mean of its neighbours, several times.
Points smoothed(Points vertices, const TriangleMesh& mesh) {
  constexpr int k_rounds = 5;  // leaves about a third of the noise, and rounds edges over two or three vertices
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<Vector3d> sums(vertices.size(), Vector3d::Zero());
    std::vector<double> counts(vertices.size(), 0);
    for (const auto& triangle : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        // The other triangle of the edge adds its ends the other way round.
        const std::uint32_t from = triangle[k];
        const std::uint32_t to = triangle[(k + 1) % 3];
        sums[to] += vertices[from];
        counts[to] += 1;
      }
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (counts[i] > 0) vertices.set(i, (vertices[i] + sums[i] / counts[i]) / 2);
    }
  }
  return vertices;
}

}  // namespace

std::vector<HouseholdThing> household_things() {
  return {plain_box(), box_with_lid(), plain_can(), can_with_rim(), open_can()};
}

Scene scan_thing(const HouseholdThing& thing, std::uint64_t seed) {
  constexpr int k_resolution = 96;  // vertices 1 % of the length apart, 2.6 times the noise
  const TriangleMesh mesh = mesh_surface(thing.model, bounds_of(thing.model), {.resolution = k_resolution});
  Scene scene{.surfaces = thing.surfaces};
  scene.exact = mesh.vertices;
  scene.noise.assign(mesh.vertices.size(), k_noise);
  RandomStream random(seed, k_household_stage);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3d place = mesh.vertices[i];
    scene.surface.push_back(nearest_surface(thing.surfaces, place));
    scene.aligned.push_back(place + k_noise * Vector3d(random.normal(), random.normal(), random.normal()));
  }
  scene.cloud.positions = smoothed(scene.aligned, mesh);
  return scene;
}

}  // namespace cloud2csg::bench
