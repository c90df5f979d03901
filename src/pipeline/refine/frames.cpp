#include "pipeline/refine/frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace cloud2csg {
namespace {

constexpr double k_uncertain = 3.0;       // standard deviations
constexpr double k_most_uncertain = 3.0;  // times the angle

enum class Directions {
  three,  // a box
  one,    // a solid of revolution
  none,   // a sphere
  other,  // any number, in any directions
};

Directions directions_of(const Primitive& primitive) {
  if (std::holds_alternative<Box>(primitive.shape)) return Directions::three;
  if (is_turned_around_axis(primitive)) return Directions::one;
  return has_no_orientation(primitive) ? Directions::none : Directions::other;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The axis, with its sign, that is nearest to a direction.
Eigen::Vector3d nearest_axis(const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  (void)direction.cwiseAbs().maxCoeff(&axis);
  Eigen::Vector3d nearest = Eigen::Vector3d::Zero();
  nearest[axis] = direction[axis] < 0 ? -1 : 1;
  return nearest;
}

struct Snapped {
  Eigen::Quaterniond in_frame;
  double angle;
};

/// The rotation by multiples of 90 degrees that is nearest to one; absent where there is none in reach.
std::optional<Snapped> snap_box(const Eigen::Quaterniond& rotation, double reach) {
  const Eigen::Matrix3d axes = rotation.toRotationMatrix();
  Eigen::Matrix3d snapped;
  for (int column = 0; column < 3; ++column) snapped.col(column) = nearest_axis(axes.col(column));
  if (std::abs(snapped.determinant() - 1) > 1e-6) return std::nullopt;
  const Eigen::Quaterniond result(snapped);
  const double angle = rotation.angularDistance(result);
  if (angle > reach) return std::nullopt;
  return Snapped{.in_frame = result, .angle = angle};
}

/// Brings the z axis to the nearest axis, and the others, which are anywhere, to the nearest ones as well.
std::optional<Snapped> snap_axis(const Eigen::Quaterniond& rotation, double reach) {
  const Eigen::Matrix3d axes = rotation.toRotationMatrix();
  const Eigen::Vector3d third = nearest_axis(axes.col(2));
  const double angle = angle_between(axes.col(2), third);
  if (angle > reach) return std::nullopt;
  Eigen::Vector3d across = axes.col(0);
  across -= across.dot(third) * third;
  const Eigen::Vector3d first = nearest_axis(across);
  Eigen::Matrix3d snapped;
  snapped << first, third.cross(first), third;
  return Snapped{.in_frame = Eigen::Quaterniond(snapped), .angle = angle};
}

class Grouping {
 public:
  Grouping(const Arrangement& separate, const PrimitiveSet& primitives,
           std::span<const MemberUncertainty> uncertainties, const OwnedPoints& points, double angle)
      : separate_(separate), primitives_(primitives), uncertainties_(uncertainties), points_(points), angle_(angle) {}

  std::vector<DirectionGroup> group() {
    for (const std::size_t member : by_importance()) {
      const Primitive& primitive = primitives_[separate_.members[member].primitive];
      const Directions directions = directions_of(primitive);
      if (directions == Directions::none && !groups_.empty()) {
        groups_[largest_group()].members.push_back({member, Eigen::Quaterniond::Identity(), 0});
      } else if (directions == Directions::other || directions == Directions::none || !joins(member, directions)) {
        groups_.push_back({.orientation = orientation_of(member),
                           .is_complete = directions != Directions::one,
                           .members = {{member, Eigen::Quaterniond::Identity(), 0}}});
        open_.push_back(directions == Directions::one || directions == Directions::three);
      }
    }
    return std::move(groups_);
  }

 private:
  [[nodiscard]] const Eigen::Quaterniond& orientation_of(std::size_t member) const {
    return separate_.frames[separate_.members[member].frame].orientation;
  }
  [[nodiscard]] std::size_t points_of(std::size_t member) const {
    return points_[separate_.members[member].primitive].size();
  }

  /// Boxes first, which have all three directions, then what has the most points; spheres at the end.
  [[nodiscard]] std::vector<std::size_t> by_importance() const {
    std::vector<std::size_t> order(separate_.members.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [this](std::size_t member) {
      const Directions directions = directions_of(primitives_[separate_.members[member].primitive]);
      return directions == Directions::three ? 0 : directions == Directions::none ? 2 : 1;
    };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
      return rank(a) != rank(b) ? rank(a) < rank(b) : points_of(a) > points_of(b);
    });
    return order;
  }

  [[nodiscard]] std::size_t largest_group() const {
    const auto size = [this](const DirectionGroup& group) {
      std::size_t sum = 0;
      for (const DirectionGroup::Member& member : group.members) sum += points_of(member.member);
      return sum;
    };
    return static_cast<std::size_t>(std::ranges::max_element(groups_, {}, size) - groups_.begin());
  }

  bool joins(std::size_t member, Directions directions) {
    const double reach = std::clamp(k_uncertain * uncertainties_[member].turn, angle_, k_most_uncertain * angle_);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      DirectionGroup& group = groups_[g];
      if (!open_[g]) continue;
      if (!group.is_complete && directions == Directions::one) complete(group, member, reach);
      const Eigen::Quaterniond rotation = group.orientation.conjugate() * orientation_of(member);
      if (directions == Directions::three && !group.is_complete) continue;
      const auto snapped = directions == Directions::three ? snap_box(rotation, reach) : snap_axis(rotation, reach);
      if (!snapped) continue;
      group.members.push_back({member, snapped->in_frame, snapped->angle});
      return true;
    }
    return false;
  }

  /// An axis across that of a group of solids of revolution gives the group its other directions.
  void complete(DirectionGroup& group, std::size_t member, double reach) const {
    const Eigen::Vector3d axis = group.orientation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d direction = orientation_of(member) * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d across = direction - direction.dot(axis) * axis;
    if (std::abs(std::asin(std::clamp(direction.dot(axis), -1.0, 1.0))) > reach) return;
    Eigen::Matrix3d axes;
    axes.col(0) = across.normalized();
    axes.col(2) = axis;
    axes.col(1) = axis.cross(axes.col(0));
    group.orientation = Eigen::Quaterniond(axes);
    group.is_complete = true;
  }

  const Arrangement& separate_;
  const PrimitiveSet& primitives_;
  std::span<const MemberUncertainty> uncertainties_;
  const OwnedPoints& points_;
  double angle_;
  std::vector<DirectionGroup> groups_;
  std::vector<bool> open_;  // by group: whether others may join
};

}  // namespace

std::vector<DirectionGroup> group_directions(const Arrangement& separate, const PrimitiveSet& primitives,
                                             std::span<const MemberUncertainty> uncertainties,
                                             const OwnedPoints& points, double angle) {
  return Grouping(separate, primitives, uncertainties, points, angle).group();
}

}  // namespace cloud2csg
