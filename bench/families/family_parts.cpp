#include "bench/families/family_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_stage = 0x66616d696c79'00;

void append_union(std::vector<CsgNode>& nodes, std::span<const CsgTree> parts) {
  if (parts.size() == 1) {
    nodes.insert(nodes.end(), parts[0].nodes().begin(), parts[0].nodes().end());
    return;
  }
  const std::size_t begin = nodes.size();
  append_union(nodes, parts.first((parts.size() + 1) / 2));
  append_union(nodes, parts.subspan((parts.size() + 1) / 2));
  nodes.push_back(CsgNode::inner(Operation::union_of, static_cast<std::uint32_t>(nodes.size() + 1 - begin)));
}

}  // namespace

CsgTree FamilyBuilder::add(Shape shape, const Pose& pose) {
  const auto index = static_cast<PrimitiveIndex>(primitives_.size());
  std::string id = fmt::format("{}_{}", type_name(shape), index + 1);
  primitives_.push_back({.id = std::move(id), .shape = std::move(shape), .pose = pose});
  return CsgTree::leaf(index);
}

Model FamilyBuilder::finish(std::string description) {
  std::vector<CsgNode> nodes;
  append_union(nodes, parts_);
  return {
      .primitives = std::move(primitives_), .tree = CsgTree(std::move(nodes)), .description = std::move(description)};
}

SpiralPath::SpiralPath(double spacing, double pitch) : spacing_(spacing), pitch_(pitch) {
  constexpr double k_least_radius_in_spacings = 10;
  angle_ = 2 * std::numbers::pi * std::max(1.0, k_least_radius_in_spacings * spacing / pitch);
}

Pose SpiralPath::next() {
  // Archimedes' spiral: the radius is proportional to the angle.
  const double growth = pitch_ / (2 * std::numbers::pi);
  const double radius = growth * angle_;
  const Vector3d outward(std::cos(angle_), std::sin(angle_), 0);
  const Vector3d tangent = (growth * outward + radius * Vector3d::UnitZ().cross(outward)).normalized();
  Eigen::Matrix3d axes;
  axes << tangent, Vector3d::UnitZ().cross(tangent), Vector3d::UnitZ();
  angle_ += spacing_ / std::hypot(growth, radius);
  return {.position = radius * outward, .orientation = Eigen::Quaterniond(axes).normalized()};
}

Eigen::Quaterniond random_orientation(RandomStream& random) {
  // Four normal numbers give a uniform direction in four dimensions.
  Eigen::Vector4d q;
  for (double& c : q) c = random.normal();
  q.normalize();
  return {q[0], q[1], q[2], q[3]};
}

Eigen::Quaterniond random_tilt(double most_deg, RandomStream& random) {
  const Vector3d axis = random_orientation(random) * Vector3d::UnitX();
  return Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(-most_deg, most_deg) * std::numbers::pi / 180, axis));
}

Vector3d random_shift(double reach, RandomStream& random) {
  return random_between(Vector3d::Constant(-reach), Vector3d::Constant(reach), random);
}

RandomStream family_stream(Family family, const FamilyOptions& options, std::size_t part) {
  return RandomStream(options.seed, k_stage + static_cast<std::uint64_t>(family), part);
}

}  // namespace cloud2csg
