#include "core/primitive/shape.hpp"

#include <array>
#include <type_traits>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

std::string_view type_name(const Shape& shape) {
  static_assert(
      std::is_same_v<Shape, std::variant<Box, Sphere, Cylinder, Cone, Torus, HalfSpace, Polytope, Expression>>,
      "the names below stand in the order of the variant");
  constexpr std::array<std::string_view, 8> k_names = {"box",   "sphere",     "cylinder", "cone",
                                                       "torus", "half_space", "polytope", "expression"};
  return k_names[shape.index()];
}

bool is_plain(const Primitive& primitive) {
  return !primitive.displacement && !std::holds_alternative<Expression>(primitive.shape);
}

bool has_exact_distance(const Primitive& primitive) {
  return is_plain(primitive) && !std::holds_alternative<Polytope>(primitive.shape);
}

bool is_convex(const Primitive& primitive) {
  return is_plain(primitive) && !std::holds_alternative<Torus>(primitive.shape);
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

}  // namespace cloud2csg
