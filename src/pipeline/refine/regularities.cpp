#include "pipeline/refine/regularities.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace cloud2csg {
namespace {

constexpr double k_uncertain = 3.0;       // standard deviations
constexpr double k_most_uncertain = 3.0;  // in multiples of the angle tolerance

enum class Directions {
  three,  // box
  one,    // solid of revolution
  none,   // sphere
  other,  // any number of arbitrary directions
};

Directions directions_of(const Primitive& primitive) {
  if (std::holds_alternative<Box>(primitive.shape)) return Directions::three;
  if (is_turned_around_axis(primitive)) return Directions::one;
  return has_no_orientation(primitive) ? Directions::none : Directions::other;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The signed coordinate axis nearest to a direction.
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

/// The nearest rotation by multiples of 90 degrees; absent beyond `reach`.
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

/// Snaps the z axis to the nearest axis, and the two free axes to the nearest ones as well.
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

  /// Boxes first, since they have all three directions, then by number of points; spheres last.
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

  /// A perpendicular axis gives a group of solids of revolution its other directions.
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

constexpr double k_same = 1e-6;  // share of the looseness within which values were equal before
constexpr double k_sigmas = 3.0;

struct Entry {
  std::size_t member, slot;
  double sign;
  double value, given;  ///< along the group's axis
  double deviation;
  double loose;
};

/// Comparable entries: of one kind, along one axis of one frame.
using Bucket = std::vector<Entry>;
using BucketKey = std::tuple<RegularityType, std::size_t, int>;

class Regulariser {
 public:
  Regulariser(const Arrangement& separate, const PrimitiveSet& primitives, const PrimitiveSet& given,
              std::span<const MemberUncertainty> uncertainties, const OwnedPoints& points,
              const RegularityLimits& limits)
      : separate_(separate),
        primitives_(primitives),
        given_(given),
        uncertainties_(uncertainties),
        points_(points),
        limits_(limits) {}

  RegularArrangement regularise() {
    const std::vector<DirectionGroup> groups =
        group_directions(separate_, primitives_, uncertainties_, points_, limits_.angle);
    for (const DirectionGroup& group : groups) add_frame(group);
    for (auto& [key, bucket] : buckets_) add_variables(std::get<0>(key), bucket);
    return std::move(result_);
  }

 private:
  [[nodiscard]] PrimitiveIndex primitive_of(std::size_t member) const { return separate_.members[member].primitive; }

  void add_frame(const DirectionGroup& group) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    Regularity directions{.type = RegularityType::directions, .primitives = {}, .spread = 0};
    for (const DirectionGroup::Member& of_group : group.members) {
      const PrimitiveIndex p = primitive_of(of_group.member);
      const auto weight = static_cast<double>(points_[p].size());
      sum += weight * separate_.frames[separate_.members[of_group.member].frame].origin;
      count += weight;
      if (has_no_orientation(primitives_[p])) continue;
      directions.primitives.push_back(p);
      directions.spread = std::max(directions.spread, of_group.angle);
      if (directions.primitives.size() > 1) result_.unknowns_saved += is_turned_around_axis(primitives_[p]) ? 2 : 3;
    }
    const std::size_t frame = result_.arrangement.frames.size();
    result_.arrangement.frames.push_back({.orientation = group.orientation, .origin = sum / std::max(count, 1.0)});
    // The group's directions as given, from its first member.
    const DirectionGroup::Member& first = group.members.front();
    const Eigen::Quaterniond given = given_[primitive_of(first.member)].pose.orientation * first.in_frame.conjugate();
    for (const DirectionGroup::Member& of_group : group.members) add_member(of_group, frame, given);
    if (directions.primitives.size() < 2) return;
    std::ranges::sort(directions.primitives);
    result_.regularities.push_back(std::move(directions));
  }

  void add_member(const DirectionGroup::Member& of_group, std::size_t frame, const Eigen::Quaterniond& given_frame) {
    const std::size_t m = result_.arrangement.members.size();
    const PrimitiveIndex p = primitive_of(of_group.member);
    result_.arrangement.members.push_back(
        {.primitive = p, .frame = frame, .in_frame = of_group.in_frame, .variables = {}, .signs = {}});
    const LocalFrame local = frame_of(result_.arrangement, result_.arrangement.members.back());
    const std::vector<Slot> now = slots_of(primitives_[p], local);
    const std::vector<Slot> before =
        slots_of(given_[p], {.orientation = given_frame * of_group.in_frame, .origin = local.origin});
    result_.arrangement.members.back().variables.resize(now.size());
    result_.arrangement.members.back().signs.resize(now.size());
    for (std::size_t k = 0; k < now.size(); ++k) {
      double sign = 1;
      int axis = -1;
      if (now[k].axis) {
        const Eigen::Vector3d direction = of_group.in_frame * Eigen::Vector3d::Unit(*now[k].axis);
        Eigen::Index nearest = 0;
        (void)direction.cwiseAbs().maxCoeff(&nearest);
        sign = direction[nearest] < 0 ? -1 : 1;
        axis = static_cast<int>(nearest);
      }
      const bool is_a_plane_anywhere = now[k].kind == RegularityType::faces && !now[k].axis;
      const bool is_radius = now[k].kind == RegularityType::radii;
      // Each plane of a polytope has a bucket of its own.
      const BucketKey key = is_a_plane_anywhere ? BucketKey{now[k].kind, frame, -2 - static_cast<int>(k)}
                            : is_radius         ? BucketKey{now[k].kind, 0, -1}
                                                : BucketKey{now[k].kind, frame, axis};
      buckets_[key].push_back({.member = m,
                               .slot = k,
                               .sign = sign,
                               .value = sign * now[k].value,
                               .given = sign * before[k].value,
                               .deviation = uncertainties_[of_group.member].slots[k],
                               .loose = looseness(primitives_[p])});
    }
  }

  [[nodiscard]] bool is_supported(const Entry& entry) const { return entry.deviation < limits_.value; }

  [[nodiscard]] bool were_equal(const Entry& a, const Entry& b) const {
    return std::abs(a.given - b.given) <= k_same * std::min(a.loose, b.loose);
  }

  /// Whether the points allow two values to be equal.
  [[nodiscard]] bool can_be_equal(const Entry& a, const Entry& b) const {
    const double difference = std::abs(a.value - b.value);
    if (were_equal(a, b)) return !is_supported(a) || !is_supported(b) || difference <= limits_.value;
    if (!is_supported(a) || !is_supported(b)) return false;
    return difference <= std::min(limits_.value, k_sigmas * std::hypot(a.deviation, b.deviation));
  }

  /// Classes of equal entries without contradictions. A primitive appears once per class, or it would become flat.
  [[nodiscard]] std::vector<Bucket> classes_of(const Bucket& bucket) const {
    std::vector<Bucket> classes;
    for (const Entry& entry : bucket) {
      const auto fits = [&](const Bucket& some) {
        return std::ranges::all_of(
            some, [&](const Entry& other) { return other.member != entry.member && can_be_equal(entry, other); });
      };
      const auto found = limits_.with_values ? std::ranges::find_if(classes, fits) : classes.end();
      if (found == classes.end()) {
        classes.push_back({entry});
      } else {
        found->push_back(entry);
      }
    }
    return classes;
  }

  void add_variables(RegularityType type, Bucket& bucket) {
    // The most certain first, so that others join them.
    std::ranges::stable_sort(bucket, {}, &Entry::deviation);
    for (const Bucket& equal : classes_of(bucket)) {
      double weights = 0;
      double sum = 0;
      double loose = equal.front().loose;
      const std::size_t variable = result_.arrangement.values.size();
      Regularity regularity{.type = type, .primitives = {}, .spread = 0};
      for (const Entry& entry : equal) {
        const double weight = 1 / (entry.deviation * entry.deviation);
        weights += weight;
        sum += weight * entry.value;
        loose = std::min(loose, entry.loose);
        Arrangement::Member& member = result_.arrangement.members[entry.member];
        member.variables[entry.slot] = variable;
        member.signs[entry.slot] = entry.sign;
        regularity.primitives.push_back(member.primitive);
        for (const Entry& other : equal) {
          regularity.spread = std::max(regularity.spread, std::abs(entry.value - other.value));
        }
      }
      const bool has_weights = weights > 0 && std::isfinite(sum / weights);
      result_.arrangement.values.push_back(has_weights ? sum / weights : equal.front().value);
      result_.arrangement.loose.push_back(loose);
      if (equal.size() < 2) continue;
      result_.unknowns_saved += equal.size() - 1;
      std::ranges::sort(regularity.primitives);
      result_.regularities.push_back(std::move(regularity));
    }
  }

  const Arrangement& separate_;
  const PrimitiveSet& primitives_;
  const PrimitiveSet& given_;
  std::span<const MemberUncertainty> uncertainties_;
  const OwnedPoints& points_;
  RegularityLimits limits_;
  RegularArrangement result_;
  std::map<BucketKey, Bucket> buckets_;
};

}  // namespace

std::vector<DirectionGroup> group_directions(const Arrangement& separate, const PrimitiveSet& primitives,
                                             std::span<const MemberUncertainty> uncertainties,
                                             const OwnedPoints& points, double angle) {
  return Grouping(separate, primitives, uncertainties, points, angle).group();
}

RegularArrangement regularised(const Arrangement& separate, const PrimitiveSet& primitives, const PrimitiveSet& given,
                               std::span<const MemberUncertainty> uncertainties, const OwnedPoints& points,
                               const RegularityLimits& limits) {
  return Regulariser(separate, primitives, given, uncertainties, points, limits).regularise();
}

}  // namespace cloud2csg
