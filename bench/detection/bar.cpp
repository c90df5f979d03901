#include "detection/bar.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/base/random.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr std::uint64_t k_bar_stage = 0x626172;
const Vector3d k_bar(1, 0.3, 0.3);
constexpr std::uint32_t k_end = 0, k_front = 2, k_back = 3, k_top = 5;  // x = 0, y = 0, y = 0.3, z = 0.3
constexpr std::uint32_t k_feature = 6;                                  // first surface after the bar's six
constexpr double k_sunk = 0.6;  // height of a ball's centre above the top, in radii: a fifth of the ball is in the bar

/// A piece of a true surface.
struct Piece {
  std::uint32_t surface;
  double area;
  std::function<Vector3d(RandomStream&)> draw;  ///< uniform by area
  std::optional<std::size_t> count = {};        ///< absent: by area and density
};

struct Part {
  std::vector<Surface> surfaces;
  std::vector<Piece> pieces;  ///< first those of the bar's faces
};

Piece rectangle(std::uint32_t surface, const Vector3d& corner, const Vector3d& u, const Vector3d& v) {
  return {.surface = surface, .area = u.cross(v).norm(), .draw = [=](RandomStream& random) -> Vector3d {
            const double along = random.uniform();
            return corner + along * u + random.uniform() * v;
          }};
}

Piece without(const Piece& piece, double area, const std::function<bool(const Vector3d&)>& is_in_hole) {
  return {.surface = piece.surface, .area = piece.area - area, .draw = [=](RandomStream& random) {
            Vector3d place = piece.draw(random);
            while (is_in_hole(place)) place = piece.draw(random);
            return place;
          }};
}

Surface plane(const Vector3d& position, const Vector3d& outward) {
  return {.type = SurfaceType::plane, .position = position, .axis = outward};
}

/// Faces in the order x = 0, x = 1, y = 0...
Part plain_bar() {
  Part part;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d u = k_bar.cwiseProduct(Vector3d::Unit((axis + 1) % 3));
    const Vector3d v = k_bar.cwiseProduct(Vector3d::Unit((axis + 2) % 3));
    for (const bool is_upper : {false, true}) {
      const Vector3d corner = is_upper ? Vector3d(k_bar.cwiseProduct(Vector3d::Unit(axis))) : Vector3d::Zero();
      part.pieces.push_back(rectangle(static_cast<std::uint32_t>(part.surfaces.size()), corner, u, v));
      part.surfaces.push_back(plane(corner, (is_upper ? 1 : -1) * Vector3d::Unit(axis)));
    }
  }
  return part;
}

/// In a corner of the top, square where the bar is wide enough.
Part with_step(Part part, double height, std::size_t points, double density) {
  const double area = static_cast<double>(points) / density;
  const double width = std::min(std::sqrt(area), k_bar.y());
  const double length = area / width;
  const double top = k_bar.z();
  part.pieces[k_top] =
      without(part.pieces[k_top], area, [=](const Vector3d& place) { return place.x() < length && place.y() < width; });
  part.surfaces.push_back(plane({0, 0, top + height}, Vector3d::UnitZ()));
  part.surfaces.push_back(plane({length, 0, 0}, Vector3d::UnitX()));
  part.surfaces.push_back(plane({0, width, 0}, Vector3d::UnitY()));
  const Vector3d u(length, 0, 0);
  const Vector3d v(0, width, 0);
  const Vector3d up(0, 0, height);
  part.pieces.push_back(rectangle(k_feature, {0, 0, top + height}, u, v));
  part.pieces.back().count = points;
  part.pieces.push_back(rectangle(k_end, {0, 0, top}, v, up));
  part.pieces.push_back(rectangle(k_front, {0, 0, top}, u, up));
  part.pieces.push_back(rectangle(k_feature + 1, {length, 0, top}, v, up));
  part.pieces.push_back(rectangle(width < k_bar.y() ? k_feature + 2 : k_back, {0, width, top}, u, up));
  return part;
}

/// Along the middle of the top, flush with the end.
Part with_thin_wall(Part part, double thickness, std::size_t points, double density) {
  const double length = std::sqrt(static_cast<double>(points) / density);
  const double low = (k_bar.y() - thickness) / 2;
  const double high = low + thickness;
  const double top = k_bar.z();
  part.pieces[k_top] = without(part.pieces[k_top], length * thickness, [=](const Vector3d& place) {
    return place.x() < length && place.y() > low && place.y() < high;
  });
  part.surfaces.push_back(plane({0, low, 0}, -Vector3d::UnitY()));
  part.surfaces.push_back(plane({0, high, 0}, Vector3d::UnitY()));
  part.surfaces.push_back(plane({length, 0, 0}, Vector3d::UnitX()));
  part.surfaces.push_back(plane({0, 0, top + length}, Vector3d::UnitZ()));
  const Vector3d along(length, 0, 0);
  const Vector3d across(0, thickness, 0);
  const Vector3d up(0, 0, length);
  part.pieces.push_back(rectangle(k_end, {0, low, top}, across, up));
  part.pieces.push_back(rectangle(k_feature + 2, {length, low, top}, across, up));
  part.pieces.push_back(rectangle(k_feature + 3, {0, low, top + length}, along, across));
  for (const bool is_upper : {false, true}) {
    part.pieces.push_back(rectangle(k_feature + (is_upper ? 1 : 0), {0, is_upper ? high : low, top}, along, up));
    part.pieces.back().count = points;
  }
  return part;
}

constexpr double k_deepest = 0.9;  // bores stay blind

/// The density at which a bore with so many points is not too deep.
double density_for_bore(double radius, std::size_t points, double density) {
  return std::max(density, static_cast<double>(points) / (2 * pi * radius * k_deepest));
}

Part with_bore(Part part, double radius, std::size_t points, double density) {
  const double depth = static_cast<double>(points) / (density * 2 * pi * radius);
  const Vector3d middle(0, k_bar.y() / 2, k_bar.z() / 2);
  const auto around = [=](double angle, double distance) -> Vector3d {
    return middle + distance * Vector3d(0, std::cos(angle), std::sin(angle));
  };
  const double area = pi * radius * radius;
  part.pieces[k_end] =
      without(part.pieces[k_end], area, [=](const Vector3d& place) { return (place - middle).norm() < radius; });
  part.surfaces.push_back({.type = SurfaceType::cylinder,
                           .position = middle,
                           .axis = Vector3d::UnitX(),
                           .radius = radius,
                           .concave = true});
  part.surfaces.push_back(plane({depth, 0, 0}, -Vector3d::UnitX()));
  part.pieces.push_back({.surface = k_feature + 1, .area = area, .draw = [=](RandomStream& random) -> Vector3d {
                           const double distance = radius * std::sqrt(random.uniform());
                           return around(random.uniform(0, 2 * pi), distance) + depth * Vector3d::UnitX();
                         }});
  const auto on_wall = [=](RandomStream& random) -> Vector3d {
    const double along = random.uniform(0, depth);
    return around(random.uniform(0, 2 * pi), radius) + along * Vector3d::UnitX();
  };
  part.pieces.push_back({.surface = k_feature, .area = 2 * pi * radius * depth, .draw = on_wall, .count = points});
  return part;
}

Vector3d random_direction(RandomStream& random) {
  const double height = random.uniform(-1, 1);
  const double angle = random.uniform(0, 2 * pi);
  const double radial = std::sqrt(1 - height * height);
  return {radial * std::cos(angle), radial * std::sin(angle), height};
}

Part with_ball(Part part, double radius, std::size_t points) {
  const Vector3d centre(0.25, k_bar.y() / 2, k_bar.z() + k_sunk * radius);
  const double mouth = radius * std::sqrt(1 - k_sunk * k_sunk);
  part.pieces[k_top] = without(part.pieces[k_top], pi * mouth * mouth,
                               [=](const Vector3d& place) { return (place - centre).head<2>().norm() < mouth; });
  part.surfaces.push_back({.type = SurfaceType::sphere, .position = centre, .radius = radius});
  const auto on_ball = [=](RandomStream& random) -> Vector3d {
    Vector3d direction = random_direction(random);
    while (direction.z() < -k_sunk) direction = random_direction(random);
    return centre + radius * direction;
  };
  part.pieces.push_back({.surface = k_feature, .area = 0, .draw = on_ball, .count = points});
  return part;
}

Part make_part(const BarOptions& options, double density) {
  const double size = options.size * options.conditions.noise;
  switch (options.feature) {
    case Feature::step:
      return with_step(plain_bar(), size, options.points, density);
    case Feature::thin_wall:
      return with_thin_wall(plain_bar(), size, options.points, density);
    case Feature::bore:
      return with_bore(plain_bar(), size, options.points, density);
    case Feature::ball:
      return with_ball(plain_bar(), size, options.points);
  }
  return plain_bar();
}

bool is_near(const Vector3d& place) {
  return place.x() < k_bar.x() / 2;
}

Scene draw_points(const Part& part, const Conditions& conditions, double density, RandomStream& random) {
  Scene scene{.surfaces = part.surfaces};
  const double highest = std::max(1.0, conditions.far_density);
  for (const Piece& piece : part.pieces) {
    const auto drawn = piece.count.value_or(static_cast<std::size_t>(std::lround(piece.area * density * highest)));
    for (std::size_t i = 0; i < drawn; ++i) {
      const Vector3d place = piece.draw(random);
      const double share = (is_near(place) ? 1 : conditions.far_density) / highest;
      if (!piece.count && !random.chance(share)) continue;
      scene.exact.push_back(place);
      scene.surface.push_back(piece.surface);
      scene.noise.push_back(conditions.noise * (is_near(place) ? 1 : conditions.far_noise));
    }
  }
  return scene;
}

Vector3d normal_vector(double sigma, RandomStream& random) {
  Vector3d vector;
  for (double& value : vector) value = sigma * random.normal();
  return vector;
}

/// Adds noise, and moves two views apart, which have half of the points each.
Scene measured(Scene scene, const Conditions& conditions, RandomStream& random) {
  scene.misalignment = conditions.misalignment * conditions.noise / 2;
  const Vector3d shift = scene.misalignment * random_direction(random);
  for (std::size_t i = 0; i < scene.exact.size(); ++i) {
    const Vector3d place = scene.exact[i] + normal_vector(scene.noise[i], random);
    scene.aligned.push_back(place);
    scene.cloud.positions.push_back(random.chance(0.5) ? Vector3d(place + shift) : Vector3d(place - shift));
  }
  return scene;
}

Scene with_copies(Scene scene, const Conditions& conditions, RandomStream& random) {
  constexpr double k_off = 0.01;  // of sigma: such as from rounding when a view is moved
  const std::size_t count = scene.cloud.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d copy = scene.cloud.positions[i] + normal_vector(k_off * conditions.noise, random);
    scene.cloud.positions.push_back(copy);
    scene.exact.push_back(scene.exact[i]);
    scene.surface.push_back(scene.surface[i]);
    scene.noise.push_back(scene.noise[i]);
  }
  return scene;
}

/// Round clusters with their middles anywhere in the bounds enlarged by 10 %.
Scene with_clusters(Scene scene, const Conditions& conditions, RandomStream& random) {
  constexpr std::size_t k_points = 100;  // of a cluster: as many as a small surface
  constexpr double k_extent = 5;         // standard deviation of a cluster, in sigma: as dense as a surface, or denser
  const auto count = static_cast<std::size_t>(conditions.clustered_outliers * static_cast<double>(scene.cloud.size()));
  const AlignedBox box = bounds_of(scene.cloud.positions);
  Vector3d middle = box.center();
  for (std::size_t i = 0; i < count; ++i) {
    if (i % k_points == 0) {
      for (int axis = 0; axis < 3; ++axis)
        middle[axis] = box.center()[axis] + random.uniform(-0.55, 0.55) * box.sizes()[axis];
    }
    const Vector3d place = middle + normal_vector(k_extent * conditions.noise, random);
    scene.cloud.positions.push_back(place);
    scene.exact.push_back(place);
    scene.surface.push_back(k_no_surface);
    scene.noise.push_back(0);
  }
  return scene;
}

Points turned(const Points& points, const Eigen::Quaterniond& turn) {
  Points result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result.set(i, turn * points[i]);
  return result;
}

/// Turns all of it, because parts along the axes of coordinates are a special case.
Scene turned(Scene scene, RandomStream& random) {
  Eigen::Quaterniond turn;
  for (double& value : turn.coeffs()) value = random.normal();
  turn.normalize();
  scene.exact = turned(scene.exact, turn);
  scene.aligned = turned(scene.aligned, turn);
  scene.cloud.positions = turned(scene.cloud.positions, turn);
  for (Surface& surface : scene.surfaces) {
    surface.position = turn * surface.position;
    surface.axis = turn * surface.axis;
  }
  return scene;
}

}  // namespace

double noise_of_ball(double size, std::size_t points, double density) {
  const double area = static_cast<double>(points) / density;
  return std::sqrt(area / (2 * pi * (1 + k_sunk))) / size;
}

Question question_of(Feature feature) {
  switch (feature) {
    case Feature::step:
      return {.surfaces = {k_feature, k_top}, .alternative = Alternative::one_plane};
    case Feature::thin_wall:
      return {.surfaces = {k_feature, k_feature + 1}, .alternative = Alternative::around_plane};
    case Feature::bore:
      return {.surfaces = {k_feature}, .alternative = Alternative::around_line};
    case Feature::ball:
      return {.surfaces = {k_feature}, .alternative = Alternative::around_place};
  }
  return {};
}

Scene make_bar(const BarOptions& options, std::uint64_t seed) {
  const Conditions& conditions = options.conditions;
  const double radius = options.size * conditions.noise;
  const double density = options.feature == Feature::bore ? density_for_bore(radius, options.points, conditions.density)
                                                          : conditions.density;
  RandomStream random(seed, k_bar_stage);
  Scene scene = measured(draw_points(make_part(options, density), conditions, density, random), conditions, random);
  if (conditions.is_seen_twice) scene = with_copies(std::move(scene), conditions, random);
  if (conditions.clustered_outliers > 0) scene = with_clusters(std::move(scene), conditions, random);
  return turned(std::move(scene), random);
}

}  // namespace cloud2csg::bench
