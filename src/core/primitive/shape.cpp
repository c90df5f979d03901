#include "core/primitive/shape.hpp"

#include <array>
#include <numbers>
#include <type_traits>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

std::string_view type_name(const Shape& shape) {
  static_assert(std::is_same_v<Shape, std::variant<Box, Sphere, Cylinder, Cone, Torus, HalfSpace, Polytope, Extrusion,
                                                   Revolution, Expression>>,
                "the names below stand in the order of the variant");
  constexpr std::array<std::string_view, 10> k_names = {
      "box", "sphere", "cylinder", "cone", "torus", "half_space", "polytope", "extrusion", "revolution", "expression"};
  return k_names[shape.index()];
}

bool is_plain(const Primitive& primitive) {
  return !primitive.displacement && !std::holds_alternative<Expression>(primitive.shape);
}

bool has_exact_distance(const Primitive& primitive) {
  return is_plain(primitive) && !std::holds_alternative<Polytope>(primitive.shape);
}

bool is_convex(const Primitive& primitive) {
  return is_plain(primitive) &&
         std::visit(Overloaded{[](const Torus&) { return false; }, [](const Extrusion&) { return false; },
                               [](const Revolution&) { return false; }, [](const auto&) { return true; }},
                    primitive.shape);
}

bool is_full_turn(const Revolution& revolution) {
  return revolution.angle_deg >= 360;
}

double turn_of(const Revolution& revolution) {
  return revolution.angle_deg / 180 * std::numbers::pi;
}

std::vector<double> lengths_of(const Shape& shape) {
  using Lengths = std::vector<double>;
  return std::visit(Overloaded{[](const Box& box) {
                                 return Lengths{box.size.x(), box.size.y(), box.size.z()};
                               },
                               [](const Sphere& sphere) { return Lengths{sphere.radius}; },
                               [](const Cylinder& cylinder) {
                                 return Lengths{cylinder.radius, cylinder.height};
                               },
                               [](const Cone& cone) {
                                 return Lengths{cone.radius_bottom, cone.radius_top, cone.height};
                               },
                               [](const Torus& torus) {
                                 return Lengths{torus.major_radius, torus.minor_radius};
                               },
                               [](const auto&) { return Lengths(); }},
                    shape);
}

Shape scaled(Shape shape, double factor) {
  const auto scale = [factor](Profile& profile) {
    for (ClosedPath& path : profile.paths) {
      for (PathCorner& corner : path) corner.point *= factor;
    }
  };
  std::visit(
      Overloaded{[&](Box& box) { box.size *= factor; }, [&](Sphere& sphere) { sphere.radius *= factor; },
                 [&](Cylinder& cylinder) { cylinder.radius *= factor, cylinder.height *= factor; },
                 [&](Cone& cone) { cone.radius_bottom *= factor, cone.radius_top *= factor, cone.height *= factor; },
                 [&](Torus& torus) { torus.major_radius *= factor, torus.minor_radius *= factor; },
                 [&](Polytope& polytope) {
                   for (Plane& plane : polytope.planes) plane.offset *= factor;
                 },
                 [&](Extrusion& extrusion) { scale(extrusion.profile), extrusion.height *= factor; },
                 [&](Revolution& revolution) { scale(revolution.profile); }, [](HalfSpace&) {}, [](Expression&) {}},
      shape);
  return shape;
}

}  // namespace cloud2csg
