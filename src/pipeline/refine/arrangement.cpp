#include "pipeline/refine/arrangement.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

constexpr double k_loose = 0.02;  // of its size

}  // namespace

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

double looseness(const Primitive& primitive) {
  const Eigen::Vector3d half = oriented_bounds(primitive).half_size;
  const double size = half.allFinite() ? 2 * half.maxCoeff() : 1.0;
  return k_loose * std::max(size, 1e-12);
}

Arrangement separate(const PrimitiveSet& primitives, const std::vector<std::optional<Eigen::Vector3d>>& origins) {
  Arrangement result;
  for (PrimitiveIndex p = 0; p < primitives.size(); ++p) {
    if (!origins[p]) continue;
    const LocalFrame frame{.orientation = primitives[p].pose.orientation, .origin = *origins[p]};
    const std::vector<Slot> slots = slots_of(primitives[p], frame);
    if (slots.empty()) continue;
    Arrangement::Member member{.primitive = p,
                               .frame = result.frames.size(),
                               .in_frame = Eigen::Quaterniond::Identity(),
                               .variables = {},
                               .signs = std::vector<double>(slots.size(), 1.0)};
    for (const Slot& slot : slots) {
      member.variables.push_back(result.values.size());
      result.values.push_back(slot.value);
      result.loose.push_back(looseness(primitives[p]));
    }
    result.frames.push_back(frame);
    result.members.push_back(std::move(member));
  }
  return result;
}

LocalFrame frame_of(const Arrangement& arrangement, const Arrangement::Member& member, const Eigen::Vector3d& turn) {
  const LocalFrame& frame = arrangement.frames[member.frame];
  return {.orientation = (rotation_by(turn) * frame.orientation * member.in_frame).normalized(),
          .origin = frame.origin};
}

PrimitiveSet arranged(const Arrangement& arrangement, PrimitiveSet primitives) {
  std::vector<double> values;
  for (const Arrangement::Member& member : arrangement.members) {
    values.clear();
    for (std::size_t k = 0; k < member.variables.size(); ++k) {
      values.push_back(member.signs[k] * arrangement.values[member.variables[k]]);
    }
    Primitive& primitive = primitives[member.primitive];
    if (auto moved = with_slots(primitive, frame_of(arrangement, member), values)) primitive = std::move(*moved);
  }
  return primitives;
}

}  // namespace cloud2csg
