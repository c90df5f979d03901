#include "pipeline/refine/regularities.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "pipeline/refine/frames.hpp"

namespace cloud2csg {
namespace {

constexpr double k_same = 1e-6;  // of how loose values are: equal before
constexpr double k_sigmas = 3.0;

/// A slot as an equation could have it.
struct Entry {
  std::size_t member, slot;
  double sign;
  double value, given;  ///< along the group's axis
  double deviation;
  double loose;
};

/// Entries that can be compared: of a kind, and along one axis of one frame.
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
    // The group's directions as they were given, by its first member.
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
      // Planes of polytopes are each for itself.
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

  /// Whether the points let two values be one.
  [[nodiscard]] bool can_be_equal(const Entry& a, const Entry& b) const {
    const double difference = std::abs(a.value - b.value);
    if (were_equal(a, b)) return !is_supported(a) || !is_supported(b) || difference <= limits_.value;
    if (!is_supported(a) || !is_supported(b)) return false;
    return difference <= std::min(limits_.value, k_sigmas * std::hypot(a.deviation, b.deviation));
  }

  /// Equal entries; none twice of the same primitive, which would make it flat, and none of which two are contradicted.
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
    // The best known first: others join these.
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

RegularArrangement regularised(const Arrangement& separate, const PrimitiveSet& primitives, const PrimitiveSet& given,
                               std::span<const MemberUncertainty> uncertainties, const OwnedPoints& points,
                               const RegularityLimits& limits) {
  return Regulariser(separate, primitives, given, uncertainties, points, limits).regularise();
}

}  // namespace cloud2csg
