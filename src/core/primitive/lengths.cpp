#include "core/primitive/lengths.hpp"

#include "core/primitive/overloaded.hpp"

namespace cloud2csg {

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
