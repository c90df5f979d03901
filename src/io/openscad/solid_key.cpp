#include "io/openscad/solid_key.hpp"

#include "core/primitive/shape.hpp"

namespace cloud2csg::scad {

std::vector<double> key_of(const Primitive& primitive) {
  std::vector<double> numbers{static_cast<double>(primitive.shape.index())};
  const auto add = [&numbers](const auto& vector) { numbers.insert(numbers.end(), vector.begin(), vector.end()); };
  add(primitive.pose.position);
  add(primitive.pose.orientation.coeffs());
  add(lengths_of(primitive.shape));
  const auto add_profile = [&](const Profile& profile) {
    for (const ClosedPath& path : profile.paths) {
      numbers.push_back(static_cast<double>(path.size()));
      for (const PathCorner& corner : path) {
        add(corner.point);
        numbers.push_back(corner.bulge);
      }
    }
  };
  if (const auto* extrusion = std::get_if<Extrusion>(&primitive.shape)) {
    numbers.push_back(extrusion->height);
    add_profile(extrusion->profile);
  }
  if (const auto* revolution = std::get_if<Revolution>(&primitive.shape)) {
    numbers.push_back(revolution->angle_deg);
    add_profile(revolution->profile);
  }
  if (const auto* polytope = std::get_if<Polytope>(&primitive.shape)) {
    for (const Plane& plane : polytope->planes) {
      add(plane.normal);
      numbers.push_back(plane.offset);
    }
  }
  return numbers;
}

}  // namespace cloud2csg::scad
