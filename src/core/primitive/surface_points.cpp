#include "core/primitive/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/primitive/polytope.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

Eigen::Vector3d doubled_area_vector(const Triangle& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

std::vector<double> areas_of(std::span<const Triangle> triangles) {
  std::vector<double> areas;
  areas.reserve(triangles.size());
  for (const Triangle& triangle : triangles) areas.push_back(0.5 * doubled_area_vector(triangle).norm());
  return areas;
}

std::vector<Triangle> triangles_of(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners) {
  std::vector<Triangle> triangles;
  triangles.reserve(corners.size());
  for (const auto& [a, b, c] : corners) triangles.push_back({vertices[a], vertices[b], vertices[c]});
  return triangles;
}

using Eigen::Vector3d;
using std::numbers::pi;

double random_angle(RandomStream& random) {
  return random.uniform(0.0, 2.0 * pi);
}

/// Uniform on the disc at height z.
Vector3d on_disc(double radius, double z, RandomStream& random) {
  const double distance = radius * std::sqrt(random.uniform());
  const double angle = random_angle(random);
  return {distance * std::cos(angle), distance * std::sin(angle), z};
}

/// Makes surfaces in the primitive's own frame. The caller places them in the world.
class LocalSurface {
 public:
  LocalSurface(const Pose& pose, const AlignedBox& region) : pose_(pose), region_(region) {}

  PrimitiveSurface operator()(const Box& box) const {
    const Vector3d size = box.size;
    const Vector3d face_area(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
    const auto draw = [size, face_area](RandomStream& random) {
      const double target = random.uniform() * face_area.sum();
      const int axis = target < face_area[0] ? 0 : target < face_area[0] + face_area[1] ? 1 : 2;
      const double side = random.chance(0.5) ? 1.0 : -1.0;
      Vector3d position;
      for (int i = 0; i < 3; ++i) position[i] = size[i] * (i == axis ? 0.5 * side : random.uniform(-0.5, 0.5));
      return SurfacePoint{.position = position, .normal = side * Vector3d::Unit(axis)};
    };
    return {.area = 2.0 * face_area.sum(), .draw = draw};
  }

  PrimitiveSurface operator()(const Sphere& sphere) const {
    const double radius = sphere.radius;
    const auto draw = [radius](RandomStream& random) {
      const double z = random.uniform(-1.0, 1.0);
      const double ring = std::sqrt(1.0 - z * z);
      const double angle = random_angle(random);
      const Vector3d normal(ring * std::cos(angle), ring * std::sin(angle), z);
      return SurfacePoint{.position = radius * normal, .normal = normal};
    };
    return {.area = 4.0 * pi * radius * radius, .draw = draw};
  }

  PrimitiveSurface operator()(const Cylinder& cylinder) const {
    return (*this)(Cone{.radius_bottom = cylinder.radius, .radius_top = cylinder.radius, .height = cylinder.height});
  }

  PrimitiveSurface operator()(const Cone& cone) const {
    const double slant = std::hypot(cone.height, cone.radius_bottom - cone.radius_top);
    const double side_area = pi * (cone.radius_bottom + cone.radius_top) * slant;
    const double bottom_area = pi * cone.radius_bottom * cone.radius_bottom;
    const double top_area = pi * cone.radius_top * cone.radius_top;
    const double area = side_area + bottom_area + top_area;
    const auto draw = [=](RandomStream& random) {
      const double target = random.uniform() * area;
      if (target < bottom_area) {
        return SurfacePoint{on_disc(cone.radius_bottom, -0.5 * cone.height, random), -Vector3d::UnitZ()};
      }
      if (target < bottom_area + top_area) {
        return SurfacePoint{on_disc(cone.radius_top, 0.5 * cone.height, random), Vector3d::UnitZ()};
      }
      return on_side(cone, slant, random);
    };
    return {.area = area, .draw = draw};
  }

  PrimitiveSurface operator()(const Torus& torus) const {
    const double major = torus.major_radius;
    const double minor = torus.minor_radius;
    const auto draw = [major, minor](RandomStream& random) {
      // A ring of the tube is longer the farther it is from the axis: accept `around` in proportion to its length.
      double around = random_angle(random);
      while (!random.chance((major + minor * std::cos(around)) / (major + minor))) around = random_angle(random);
      const double angle = random_angle(random);
      const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
      const Vector3d normal = std::cos(around) * outward + std::sin(around) * Vector3d::UnitZ();
      return SurfacePoint{.position = major * outward + minor * normal, .normal = normal};
    };
    return {.area = 4.0 * pi * pi * major * minor, .draw = draw};
  }

  PrimitiveSurface operator()(const HalfSpace& /*half_space*/) const {
    // The plane cuts the ball around the region in this disc.
    const Vector3d centre = pose_.to_local(region_.center());
    const double square = 0.25 * region_.diagonal().squaredNorm() - centre.z() * centre.z();
    if (square <= 0.0) return {};
    const double radius = std::sqrt(square);
    const auto draw = [centre, radius](RandomStream& random) {
      const Vector3d middle(centre.x(), centre.y(), 0.0);
      return SurfacePoint{.position = middle + on_disc(radius, 0.0, random), .normal = Vector3d::UnitZ()};
    };
    return {.area = pi * square, .draw = draw};
  }

  PrimitiveSurface operator()(const Polytope& polytope) const { return surface_of(triangles_of(polytope)); }

  PrimitiveSurface operator()(const Extrusion& extrusion) const {
    const std::vector<ProfileSegment> segments = segments_of(extrusion.profile);
    const double height = extrusion.height;
    std::vector<double> lengths(segments.size());
    std::ranges::transform(segments, lengths.begin(), [](const ProfileSegment& s) { return s.length(); });
    const WeightedChoice side(lengths);
    const auto draw = [segments, height, side](RandomStream& random) {
      const ProfileSegment& s = segments[side.draw(random)];
      const double share = random.uniform();
      const Eigen::Vector2d place = s.at(share);
      const Eigen::Vector2d normal = s.normal(share);
      return SurfacePoint{.position = {place.x(), place.y(), random.uniform(-0.5, 0.5) * height},
                          .normal = {normal.x(), normal.y(), 0}};
    };
    return with_caps({.area = height * side.total(), .draw = draw}, extrusion);
  }

  PrimitiveSurface operator()(const Revolution& revolution) const {
    return with_caps(turned_surface(segments_of(revolution.profile), 0, turn_of(revolution)), revolution);
  }

  PrimitiveSurface operator()(const Expression& /*expression*/) const { return {}; }

 private:
  template <class Swept>
  static PrimitiveSurface with_caps(PrimitiveSurface sides, const Swept& swept) {
    std::vector<PrimitiveSurface> ends;
    const std::vector<ProfileSegment> segments = segments_of(swept.profile);
    for (const ProfileCap& cap : caps_of(swept)) {
      ends.push_back(cap_surface(cap, segments, bounds_of(segments), area_of(swept.profile)));
    }
    if (ends.empty()) return sides;
    return joined({joined(std::move(ends)), std::move(sides)});
  }

  static SurfacePoint on_side(const Cone& cone, double slant, RandomStream& random) {
    // A ring is as long as its radius, so the square of the radius is uniform.
    const double bottom = cone.radius_bottom;
    const double top = cone.radius_top;
    const double radius = std::sqrt(bottom * bottom + random.uniform() * (top * top - bottom * bottom));
    // Near a cylinder the quotient loses its digits. The height is practically uniform then.
    constexpr double k_nearly_equal = 1e-6;
    const bool is_cylinder = std::abs(top - bottom) < k_nearly_equal * (top + bottom);
    const double share = is_cylinder ? random.uniform() : (radius - bottom) / (top - bottom);
    const double ring = is_cylinder ? bottom + share * (top - bottom) : radius;
    const double angle = random_angle(random);
    const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
    return {.position = ring * outward + (share - 0.5) * cone.height * Vector3d::UnitZ(),
            .normal = (cone.height * outward + (bottom - top) * Vector3d::UnitZ()) / slant};
  }

  const Pose& pose_;
  const AlignedBox& region_;
};

}  // namespace

WeightedChoice::WeightedChoice(std::span<const double> weights) {
  sums_.reserve(weights.size());
  double sum = 0.0;
  for (const double weight : weights) {
    sum += weight;
    sums_.push_back(sum);
  }
}

std::size_t WeightedChoice::draw(RandomStream& random) const {
  const double target = random.uniform() * total();
  // Rounding of the product may reach the end of the last entry: step back to one with weight.
  auto found = std::upper_bound(sums_.begin(), sums_.end(), target);
  if (found == sums_.end()) found = std::lower_bound(sums_.begin(), found, total());
  return static_cast<std::size_t>(found - sums_.begin());
}

TriangleSampler::TriangleSampler(std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)), choice_(areas_of(triangles_)) {}

TriangleSampler::TriangleSampler(const Points& vertices, std::span<const std::array<std::uint32_t, 3>> corners)
    : TriangleSampler(triangles_of(vertices, corners)) {}

TriangleSampler::Draw TriangleSampler::draw(RandomStream& random) const {
  const std::size_t index = choice_.draw(random);
  const Triangle& triangle = triangles_[index];
  const double root = std::sqrt(random.uniform());
  const double share = random.uniform();
  return {.position = (1.0 - root) * triangle[0] + root * (1.0 - share) * triangle[1] + root * share * triangle[2],
          .triangle = index};
}

Eigen::Vector3d TriangleSampler::normal(std::size_t triangle) const {
  return doubled_area_vector(triangles_[triangle]).normalized();
}

std::vector<Triangle> triangles_of(const Polytope& polytope) {
  const auto [corners, faces] = faces_of(polytope);
  std::vector<Triangle> triangles;
  for (const std::vector<std::size_t>& face : faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      triangles.push_back({corners[face[0]], corners[face[i]], corners[face[i + 1]]});
    }
  }
  return triangles;
}

PrimitiveSurface surface_of(std::vector<Triangle> triangles) {
  TriangleSampler sampler(std::move(triangles));
  const double area = sampler.area();
  const auto draw = [sampler = std::move(sampler)](RandomStream& random) {
    const TriangleSampler::Draw drawn = sampler.draw(random);
    return SurfacePoint{.position = drawn.position, .normal = sampler.normal(drawn.triangle)};
  };
  return {.area = area, .draw = draw};
}

PrimitiveSurface turned_surface(std::vector<ProfileSegment> segments, double from, double to) {
  // Draws from a ring as wide as the segment's farthest point, then keeps the point in proportion to its own ring.
  std::vector<double> most_radius;
  std::vector<double> most_area;
  double area = 0;
  for (const ProfileSegment& s : segments) {
    most_radius.push_back(extent_along(s, Eigen::Vector2d::UnitX()).second);
    most_area.push_back((to - from) * s.length() * most_radius.back());
    area += (to - from) * s.first_moment();
  }
  const auto draw = [segments = std::move(segments), most_radius = std::move(most_radius),
                     choice = WeightedChoice(most_area), from, to](RandomStream& random) {
    while (true) {
      const std::size_t i = choice.draw(random);
      const double share = random.uniform();
      const Eigen::Vector2d place = segments[i].at(share);
      if (!random.chance(place.x() / most_radius[i])) continue;
      const Eigen::Vector2d normal = segments[i].normal(share);
      const double angle = random.uniform(from, to);
      const Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
      return SurfacePoint{.position = place.x() * outward + place.y() * Vector3d::UnitZ(),
                          .normal = normal.x() * outward + normal.y() * Vector3d::UnitZ()};
    }
  };
  return {.area = area, .draw = draw};
}

std::vector<ProfileCap> caps_of(const Extrusion& extrusion) {
  std::vector<ProfileCap> caps;
  for (const double side : {1.0, -1.0}) {
    caps.push_back({.origin = 0.5 * side * extrusion.height * Vector3d::UnitZ(),
                    .x_axis = Vector3d::UnitX(),
                    .y_axis = Vector3d::UnitY(),
                    .normal = side * Vector3d::UnitZ()});
  }
  return caps;
}

std::vector<ProfileCap> caps_of(const Revolution& revolution) {
  if (is_full_turn(revolution)) return {};
  const double angle = turn_of(revolution);
  const Vector3d end(std::cos(angle), std::sin(angle), 0);
  return {{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitZ(), -Vector3d::UnitY()},
          {Vector3d::Zero(), end, Vector3d::UnitZ(), Vector3d::UnitZ().cross(end)}};
}

PrimitiveSurface cap_surface(const ProfileCap& cap, std::vector<ProfileSegment> segments,
                             const Eigen::AlignedBox2d& box, double area) {
  const auto draw = [cap, segments = std::move(segments), box](RandomStream& random) {
    Eigen::Vector2d place;
    do {
      for (int axis = 0; axis < 2; ++axis) place[axis] = random.uniform(box.min()[axis], box.max()[axis]);
    } while (!is_inside(segments, place));
    return SurfacePoint{.position = cap.origin + place.x() * cap.x_axis + place.y() * cap.y_axis, .normal = cap.normal};
  };
  return {.area = area, .draw = draw};
}

PrimitiveSurface joined(std::vector<PrimitiveSurface> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  std::vector<double> areas(parts.size());
  std::ranges::transform(parts, areas.begin(), &PrimitiveSurface::area);
  const WeightedChoice choice(areas);
  const auto draw = [parts = std::move(parts), choice](RandomStream& random) {
    return parts[choice.draw(random)].draw(random);
  };
  return {.area = choice.total(), .draw = draw};
}

PrimitiveSurface placed(PrimitiveSurface local, const Pose& pose) {
  const auto place = [pose, draw = std::move(local.draw)](RandomStream& random) {
    const SurfacePoint point = draw(random);
    return SurfacePoint{.position = pose.to_world(point.position), .normal = pose.orientation * point.normal};
  };
  return {.area = local.area, .draw = place};
}

PrimitiveSurface make_plain_surface(const Primitive& primitive, const AlignedBox& region) {
  return placed(std::visit(LocalSurface(primitive.pose, region), primitive.shape), primitive.pose);
}

}  // namespace cloud2csg
