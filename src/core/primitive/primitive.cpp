#include "cloud2csg/primitive.hpp"

#include <array>
#include <type_traits>

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

}  // namespace cloud2csg
