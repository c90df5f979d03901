#include "pipeline/refine/slots.hpp"

#include <array>

#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

Slot centre(int axis, const Eigen::Vector3d& place) {
  return {RegularityType::centres, axis, place[axis]};
}
Slot face(int axis, double value) {
  return {RegularityType::faces, axis, value};
}
Slot radius(double value) {
  return {RegularityType::radii, {}, value};
}

/// Reads values in the order of slots_of().
class Reader {
 public:
  Reader(std::span<const double> values, Eigen::Vector3d place) : values_(values), place_(std::move(place)) {}

  double next() { return values_[next_++]; }
  void centre(int axis) { place_[axis] = next(); }
  /// Reads two opposite faces; sets the middle between them and returns their distance.
  double faces(int axis) {
    const double low = next();
    const double high = next();
    place_[axis] = (low + high) / 2;
    return high - low;
  }
  [[nodiscard]] const Eigen::Vector3d& place() const { return place_; }

 private:
  std::span<const double> values_;
  Eigen::Vector3d place_;
  std::size_t next_ = 0;
};

bool has_volume(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Box& box) { return box.size.minCoeff() > 0; },
                 [](const Sphere& sphere) { return sphere.radius > 0; },
                 [](const Cylinder& cylinder) { return cylinder.radius > 0 && cylinder.height > 0; },
                 [](const Cone& cone) {
                   return cone.radius_bottom >= 0 && cone.radius_top >= 0 && cone.height > 0 &&
                          cone.radius_bottom + cone.radius_top > 0;
                 },
                 [](const Torus& torus) { return torus.minor_radius > 0 && torus.minor_radius <= torus.major_radius; },
                 [](const Extrusion& extrusion) { return extrusion.height > 0; }, [](const auto&) { return true; }},
      shape);
}

Shape shape_from(const Shape& original, Reader& reader) {
  return std::visit(Overloaded{[&](Box box) -> Shape {
                                 for (int axis = 0; axis < 3; ++axis) box.size[axis] = reader.faces(axis);
                                 return box;
                               },
                               [&](Sphere sphere) -> Shape {
                                 for (int axis = 0; axis < 3; ++axis) reader.centre(axis);
                                 sphere.radius = reader.next();
                                 return sphere;
                               },
                               [&](Cylinder cylinder) -> Shape {
                                 for (int axis = 0; axis < 2; ++axis) reader.centre(axis);
                                 cylinder.height = reader.faces(2);
                                 cylinder.radius = reader.next();
                                 return cylinder;
                               },
                               [&](Cone cone) -> Shape {
                                 for (int axis = 0; axis < 2; ++axis) reader.centre(axis);
                                 cone.height = reader.faces(2);
                                 if (cone.radius_bottom > 0) cone.radius_bottom = reader.next();
                                 if (cone.radius_top > 0) cone.radius_top = reader.next();
                                 return cone;
                               },
                               [&](Torus torus) -> Shape {
                                 for (int axis = 0; axis < 3; ++axis) reader.centre(axis);
                                 torus.major_radius = reader.next();
                                 torus.minor_radius = reader.next();
                                 return torus;
                               },
                               [&](HalfSpace half_space) -> Shape {
                                 reader.centre(2);
                                 return half_space;
                               },
                               [&](Polytope polytope) -> Shape {
                                 for (Plane& plane : polytope.planes) plane.offset = reader.next();
                                 return polytope;
                               },
                               [&](Extrusion extrusion) -> Shape {
                                 for (int axis = 0; axis < 2; ++axis) reader.centre(axis);
                                 extrusion.height = reader.faces(2);
                                 return extrusion;
                               },
                               [&](const Revolution& revolution) -> Shape {
                                 for (int axis = 0; axis < 3; ++axis) reader.centre(axis);
                                 return revolution;
                               },
                               [](const Expression& expression) -> Shape { return expression; }},
                    original);
}

}  // namespace

std::vector<Slot> slots_of(const Primitive& primitive, const LocalFrame& frame) {
  const Eigen::Vector3d place = frame.orientation.conjugate() * (primitive.pose.position - frame.origin);
  const auto faces_across = [&place](int axis, double size) {
    return std::array{face(axis, place[axis] - size / 2), face(axis, place[axis] + size / 2)};
  };
  std::vector<Slot> slots;
  const auto add = [&slots](const auto& some) { slots.insert(slots.end(), some.begin(), some.end()); };
  const auto add_centres = [&](int count) {
    for (int axis = 0; axis < count; ++axis) slots.push_back(centre(axis, place));
  };
  std::visit(Overloaded{[&](const Box& box) {
                          for (int axis = 0; axis < 3; ++axis) add(faces_across(axis, box.size[axis]));
                        },
                        [&](const Sphere& sphere) {
                          add_centres(3);
                          slots.push_back(radius(sphere.radius));
                        },
                        [&](const Cylinder& cylinder) {
                          add_centres(2);
                          add(faces_across(2, cylinder.height));
                          slots.push_back(radius(cylinder.radius));
                        },
                        [&](const Cone& cone) {
                          add_centres(2);
                          add(faces_across(2, cone.height));
                          if (cone.radius_bottom > 0) slots.push_back(radius(cone.radius_bottom));
                          if (cone.radius_top > 0) slots.push_back(radius(cone.radius_top));
                        },
                        [&](const Torus& torus) {
                          add_centres(3);
                          slots.push_back(radius(torus.major_radius));
                          slots.push_back(radius(torus.minor_radius));
                        },
                        [&](const HalfSpace&) { slots.push_back(face(2, place.z())); },
                        [&](const Polytope& polytope) {
                          for (const Plane& plane : polytope.planes) {
                            slots.push_back({RegularityType::faces, {}, plane.offset});
                          }
                        },
                        // The profile itself stays.
                        [&](const Extrusion& extrusion) {
                          add_centres(2);
                          add(faces_across(2, extrusion.height));
                        },
                        [&](const Revolution&) { add_centres(3); }, [](const Expression&) {}},
             primitive.shape);
  return slots;
}

std::optional<Primitive> with_slots(const Primitive& original, const LocalFrame& frame,
                                    std::span<const double> values) {
  const bool keeps_its_place = std::holds_alternative<Polytope>(original.shape);
  // Values without a slot stay, along the primitive's own axes.
  const Eigen::Vector3d before = frame.orientation.conjugate() * (original.pose.position - frame.origin);
  Reader reader(values, before);
  Primitive result = original;
  result.evidence.reset();  // it describes the old position
  result.shape = shape_from(original.shape, reader);
  if (!has_no_orientation(original)) result.pose.orientation = frame.orientation;
  if (!keeps_its_place) result.pose.position = frame.origin + frame.orientation * reader.place();
  if (!has_volume(result.shape)) return std::nullopt;
  return result;
}

bool is_turned_around_axis(const Primitive& primitive) {
  if (primitive.displacement) return false;
  return std::visit(Overloaded{[](const Cylinder&) { return true; }, [](const Cone&) { return true; },
                               [](const Torus&) { return true; }, [](const HalfSpace&) { return true; },
                               [](const Revolution& revolution) { return is_full_turn(revolution); },
                               [](const auto&) { return false; }},
                    primitive.shape);
}

bool has_no_orientation(const Primitive& primitive) {
  return !primitive.displacement && std::holds_alternative<Sphere>(primitive.shape);
}

}  // namespace cloud2csg
