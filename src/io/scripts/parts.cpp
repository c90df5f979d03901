#include "io/scripts/parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/primitive/shape.hpp"

namespace cloud2csg::script {
namespace {

constexpr double k_no_fit = std::numeric_limits<double>::infinity();

double size_difference(const Shape& a, const Shape& b) {
  const std::vector<double> lengths = lengths_of(a);
  if (a.index() != b.index() || lengths.empty()) return k_no_fit;
  const std::vector<double> others = lengths_of(b);
  double most = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) most = std::max(most, std::abs(lengths[i] - others[i]));
  return most;
}

/// Distance between the unit directions of two solids' axes; ignores rotations that are symmetries.
double turn_difference(const Primitive& a, const Primitive& b) {
  if (std::holds_alternative<Sphere>(a.shape)) return 0;
  const Eigen::Matrix3d m = a.pose.orientation.toRotationMatrix();
  const Eigen::Matrix3d n = b.pose.orientation.toRotationMatrix();
  const auto line = [&](int axis) {
    return std::min((m.col(axis) - n.col(axis)).norm(), (m.col(axis) + n.col(axis)).norm());
  };
  if (std::holds_alternative<Box>(a.shape)) return std::max({line(0), line(1), line(2)});
  if (std::holds_alternative<Cone>(a.shape)) return (m.col(2) - n.col(2)).norm();
  return line(2);
}

/// Maps the pose of each solid in a part.
template <class Map>
Part mapped(const Part& part, const Map& map) {
  Part result{.kind = part.kind, .solid = part.solid};
  if (part.kind == Part::Kind::solid) result.solid.pose = map(part.solid.pose);
  for (const Part& operand : part.kept) result.kept.push_back(mapped(operand, map));
  for (const Part& operand : part.removed) result.removed.push_back(mapped(operand, map));
  return result;
}

template <class Visit>
void for_each_solid(const Part& part, const Visit& visit) {
  if (part.kind == Part::Kind::solid) visit(part.solid);
  for (const Part& operand : part.kept) for_each_solid(operand, visit);
  for (const Part& operand : part.removed) for_each_solid(operand, visit);
}

template <class Difference>
double largest_difference(const Part& a, const Part& b, double tolerance, const Difference& difference);

/// Matches each operand with the first free operand that fits. Only coincident operands fit twice.
template <class Difference>
double largest_difference(const std::vector<Part>& a, const std::vector<Part>& b, double tolerance,
                          const Difference& difference) {
  if (a.size() != b.size()) return k_no_fit;
  std::vector<bool> is_taken(b.size(), false);
  double most = 0;
  for (const Part& operand : a) {
    bool is_found = false;
    for (std::size_t i = 0; i < b.size() && !is_found; ++i) {
      if (is_taken[i]) continue;
      const double found = largest_difference(operand, b[i], tolerance, difference);
      if (found > tolerance) continue;
      is_found = is_taken[i] = true;
      most = std::max(most, found);
    }
    if (!is_found) return k_no_fit;
  }
  return most;
}

template <class Difference>
double largest_difference(const Part& a, const Part& b, double tolerance, const Difference& difference) {
  if (a.kind != b.kind) return k_no_fit;
  if (a.kind == Part::Kind::solid) return difference(a.solid, b.solid);
  const double kept = largest_difference(a.kept, b.kept, tolerance, difference);
  if (kept > tolerance) return k_no_fit;
  return std::max(kept, largest_difference(a.removed, b.removed, tolerance, difference));
}

}  // namespace

Part moved(const Part& part, const Pose& motion) {
  return mapped(part, [&motion](const Pose& pose) { return compose(motion, pose); });
}

Part mirrored(const Part& part, const MirrorPlane& plane) {
  const Eigen::Matrix3d flip = Eigen::Matrix3d::Identity() - 2 * plane.normal * plane.normal.transpose();
  // Each repeatable solid is symmetric in its own x. Mirroring in it makes the reflection a rotation.
  const Eigen::Vector3d own(-1, 1, 1);
  return mapped(part, [&](const Pose& pose) {
    const Eigen::Matrix3d turn = flip * pose.orientation.toRotationMatrix() * own.asDiagonal();
    return Pose{.position = flip * pose.position + 2 * plane.offset * plane.normal,
                .orientation = Eigen::Quaterniond(turn)};
  });
}

Eigen::Vector3d centre_of(const Part& part) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for_each_solid(part, [&sum](const Primitive& solid) { sum += solid.pose.position; });
  return sum / static_cast<double>(solid_count(part));
}

std::size_t solid_count(const Part& part) {
  std::size_t count = 0;
  for_each_solid(part, [&count](const Primitive& /*solid*/) { ++count; });
  return count;
}

bool can_repeat(const Primitive& primitive) {
  return !primitive.displacement && primitive.shape.index() <= Shape(Torus{}).index();
}

double misfit(const Primitive& a, const Primitive& b) {
  if (!can_repeat(a) || !can_repeat(b)) return k_no_fit;
  const double size = size_difference(a.shape, b.shape);
  if (size == k_no_fit) return size;
  const double place = (a.pose.position - b.pose.position).norm();
  return size + place + turn_difference(a, b) * oriented_bounds(a).half_size.norm();
}

double misfit(const Part& a, const Part& b, double tolerance) {
  return largest_difference(a, b, tolerance,
                            [](const Primitive& one, const Primitive& other) { return misfit(one, other); });
}

bool are_alike(const Part& a, const Part& b, double tolerance) {
  return largest_difference(a, b, tolerance, [](const Primitive& one, const Primitive& other) {
           return size_difference(one.shape, other.shape);
         }) <= tolerance;
}

}  // namespace cloud2csg::script
