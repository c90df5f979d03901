#include "raw/prepare/patches.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <queue>
#include <tuple>

#include "raw/prepare/constants.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Weight of a vote of two neighbours, relative to a winding number that is wrong by one at one point.
constexpr double k_vote_weight = 0.1;
/// Share of the total weight below which a gain is rounding.
constexpr double k_least_gain = 1e-7;
constexpr std::uint32_t k_none = UINT32_MAX;

/// A binary forest of patches and groups. Children come before their parents, and roots come last.
struct Groups {
  std::size_t patches = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> children;  ///< entry i is group patches + i
  std::vector<std::uint32_t> parents;
  std::vector<char> flipped;           ///< for each patch, according to the votes
  std::vector<std::uint32_t> body_of;  ///< the topmost group made by votes alone
};

/// Repeatedly joins the pair of groups with the largest absolute sum of votes.
class GroupBuilder {
 public:
  GroupBuilder(std::size_t patches, std::span<const PatchVote> votes) : sets_(patches), between_(2 * patches) {
    groups_.patches = patches;
    groups_.parents.assign(2 * patches, k_none);
    member_.resize(2 * patches);
    for (std::uint32_t i = 0; i < patches; ++i) member_[i] = i;
    for (const PatchVote& vote : votes) {
      between_[vote.one][vote.other] = vote.votes;
      between_[vote.other][vote.one] = vote.votes;
      queue_.emplace(std::abs(vote.votes), vote.one, vote.other);
    }
  }

  Groups build() && {
    while (!queue_.empty()) {
      const auto [strength, one, other] = queue_.top();
      queue_.pop();
      if (groups_.parents[one] != k_none || groups_.parents[other] != k_none) continue;
      join(one, other);
    }
    std::vector<std::uint32_t> tops;
    const auto joined = static_cast<std::uint32_t>(groups_.patches + groups_.children.size());
    for (std::uint32_t group = 0; group < joined; ++group) {
      if (groups_.parents[group] == k_none) tops.push_back(group);
    }
    for (std::uint32_t i = 0; i < groups_.patches; ++i) {
      std::uint32_t top = i;
      while (groups_.parents[top] != k_none) top = groups_.parents[top];
      groups_.body_of.push_back(top);
      groups_.flipped.push_back(sets_.find(i).is_flipped ? 1 : 0);
    }
    for (std::size_t i = 1; i < tops.size(); ++i) {
      tops[i] = add_group(tops[i - 1], tops[i]);
    }
    return std::move(groups_);
  }

 private:
  std::uint32_t add_group(std::uint32_t one, std::uint32_t other) {
    const auto group = static_cast<std::uint32_t>(groups_.patches + groups_.children.size());
    groups_.children.emplace_back(one, other);
    groups_.parents[one] = groups_.parents[other] = group;
    member_[group] = member_[one];
    return group;
  }
  void join(std::uint32_t one, std::uint32_t other) {
    const double votes = between_[one][other];
    between_[one].erase(other);
    between_[other].erase(one);
    const double sign = votes < 0.0 ? -1.0 : 1.0;
    const std::uint32_t group = add_group(one, other);
    sets_.join(member_[one], member_[other], votes < 0.0);
    std::map<std::uint32_t, double> sums = std::move(between_[one]);
    for (const auto& [neighbour, value] : between_[other]) sums[neighbour] += sign * value;
    between_[one].clear();
    between_[other].clear();
    for (const auto& [neighbour, value] : sums) {
      between_[neighbour].erase(one);
      between_[neighbour].erase(other);
      between_[neighbour][group] = value;
      queue_.emplace(std::abs(value), group, neighbour);
    }
    between_[group] = std::move(sums);
  }

  Groups groups_;
  SignedSets sets_;
  std::vector<std::map<std::uint32_t, double>> between_;
  std::vector<std::uint32_t> member_;  ///< a patch of each group; the group's votes are relative to the patch's sign
  std::priority_queue<std::tuple<double, std::uint32_t, std::uint32_t>> queue_;
};

/// The energy, and the gain of flipping a group.
class SignSearch {
 public:
  SignSearch(const PatchFields& fields, std::span<const double> weights, std::span<const PatchVote> votes,
             Groups& groups)
      : fields_(fields), weights_(weights), votes_(votes), groups_(groups) {
    signs_.resize(groups.patches);
    for (std::size_t i = 0; i < groups.patches; ++i) signs_[i] = groups.flipped[i] != 0 ? -1.0F : 1.0F;
    rest_.assign(groups.patches, -0.5F);
    for (std::size_t source = 0; source < groups.patches; ++source) add(rest_, fields.of(source), signs_[source]);
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    least_gain_ = k_least_gain * sum;
    incident_.resize(groups.patches);
    for (std::uint32_t v = 0; v < votes.size(); ++v) {
      incident_[votes[v].one].push_back(v);
      incident_[votes[v].other].push_back(v);
    }
    order_groups();
  }

  /// Flips the groups with the largest gains, rechecking each after the previous flips. @returns whether any flipped.
  bool turn_best() {
    std::vector<std::pair<double, std::uint32_t>> gains;
    for_each_group([&](std::uint32_t group, std::vector<float>& column) {
      const double gain = gain_of(group, column);
      if (gain > least_gain_) gains.emplace_back(gain, group);
    });
    const std::size_t tried = std::min(k_best, gains.size());
    std::partial_sort(gains.begin(), gains.begin() + static_cast<std::ptrdiff_t>(tried), gains.end(), std::greater<>());
    gains.resize(tried);
    bool any = false;
    for (const auto& [gain, group] : gains) {
      std::vector<float> column(groups_.patches, 0.0F);
      for (std::uint32_t place = begins_[group]; place < ends_[group]; ++place) {
        add(column, fields_.of(leaves_[place]), signs_[leaves_[place]]);
      }
      // The flips before this one lessened its gain.
      if (gain_of(group, column) < k_clear_share * gain) continue;
      turn(group);
      add(rest_, column, -2.0F);
      any = true;
    }
    return any;
  }

  /// Flips each group that gains, children before parents. @returns whether any gained.
  bool sweep() {
    bool any = false;
    for_each_group([&](std::uint32_t group, std::vector<float>& column) {
      if (gain_of(group, column) <= least_gain_) return;
      turn(group);
      add(rest_, column, -2.0F);
      for (float& value : column) value = -value;
      any = true;
    });
    return any;
  }

  [[nodiscard]] std::vector<char> flipped() const {
    std::vector<char> flipped;
    for (const float sign : signs_) flipped.push_back(sign < 0.0F ? 1 : 0);
    return flipped;
  }
  [[nodiscard]] std::vector<double> windings() const {
    std::vector<double> windings;
    for (const float rest : rest_) windings.push_back(rest + 0.5);
    return windings;
  }

 private:
  static void add(std::vector<float>& sum, std::span<const float> values, float factor) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * values[i];
  }

  /// Children before parents, so that few columns are in use at a time.
  void order_groups() {
    const std::size_t all = groups_.patches + groups_.children.size();
    begins_.resize(all);
    ends_.resize(all);
    if (all == 0) return;
    std::vector<std::pair<std::uint32_t, bool>> stack{{static_cast<std::uint32_t>(all - 1), false}};
    while (!stack.empty()) {
      const auto [group, is_open] = stack.back();
      stack.pop_back();
      if (group < groups_.patches) {
        begins_[group] = static_cast<std::uint32_t>(leaves_.size());
        leaves_.push_back(group);
      } else if (!is_open) {
        const auto [one, other] = groups_.children[group - groups_.patches];
        begins_[group] = static_cast<std::uint32_t>(leaves_.size());
        stack.insert(stack.end(), {{group, true}, {other, false}, {one, false}});
        continue;
      }
      ends_[group] = static_cast<std::uint32_t>(leaves_.size());
      order_.push_back(group);
    }
  }
  /// Current votes across a group's border: positive if it agrees with its surroundings.
  [[nodiscard]] double border_of(std::uint32_t group) const {
    double sum = 0.0;
    for (std::uint32_t place = begins_[group]; place < ends_[group]; ++place) {
      for (const std::uint32_t v : incident_[leaves_[place]]) {
        const std::uint32_t other = votes_[v].one == leaves_[place] ? votes_[v].other : votes_[v].one;
        const std::uint32_t at = begins_[other];
        if (at < begins_[group] || at >= ends_[group]) sum += votes_[v].votes * signs_[leaves_[place]] * signs_[other];
      }
    }
    return sum;
  }
  /// Calls work(group, its field) for all groups, children before parents.
  template <typename Work>
  void for_each_group(const Work& work) {
    std::vector<std::vector<float>> columns;
    for (const std::uint32_t group : order_) {
      combine(group, columns);
      work(group, columns.back());
    }
  }
  /// Replaces the children's columns by the group's.
  void combine(std::uint32_t group, std::vector<std::vector<float>>& columns) const {
    if (group < groups_.patches) {
      columns.emplace_back(groups_.patches, 0.0F);
      add(columns.back(), fields_.of(group), signs_[group]);
    } else {
      add(columns[columns.size() - 2], columns.back(), 1.0F);
      columns.pop_back();
    }
  }
  [[nodiscard]] double gain_of(std::uint32_t group, const std::vector<float>& column) const {
    double change = 0.0;
    for (std::size_t i = 0; i < column.size(); ++i) {
      change += weights_[i] * static_cast<double>(column[i] * (column[i] - rest_[i]));
    }
    return -4.0 * change - 2.0 * k_vote_weight * border_of(group);
  }
  void turn(std::uint32_t group) {
    for (std::uint32_t place = begins_[group]; place < ends_[group]; ++place) {
      signs_[leaves_[place]] = -signs_[leaves_[place]];
    }
  }

  const PatchFields& fields_;
  std::span<const double> weights_;
  std::span<const PatchVote> votes_;
  const Groups& groups_;
  std::vector<float> signs_;
  std::vector<float> rest_;                            ///< winding number at each patch, minus one half
  std::vector<std::vector<std::uint32_t>> incident_;   ///< votes of each patch
  std::vector<std::uint32_t> order_;                   ///< groups, children before parents
  std::vector<std::uint32_t> leaves_, begins_, ends_;  ///< patches, and each group's range among them
  double least_gain_ = 0.0;
};

/// Whether two places, a step apart, may be on one smooth surface. The normals must be alike up to sign, and the step
/// must lie in the surface within the angle between them. Rejects the other side of a wall.
bool on_one_surface(const Vector3d& step, const Vector3d& normal, const Vector3d& other, double noise) {
  const double cosine = std::abs(normal.dot(other));
  if (cosine < k_alike_cosine) return false;
  // The angle between a chord and its tangents is half of the angle between the tangents.
  const double half_tangent = std::sqrt(std::max(0.0, 1.0 - cosine) / (1.0 + cosine));
  const double rise = std::max(std::abs(step.dot(normal)), std::abs(step.dot(other)));
  return rise <= (k_bend_tolerance + 1.25 * half_tangent) * step.norm() + noise;
}

}  // namespace

std::vector<double> surface_areas(const Points& places, const Points& normals, const NeighbourTable& neighbours,
                                  double noise) {
  std::vector<double> areas(places.size(), 0.0);
  const std::size_t near = std::max(std::min(k_nearest, neighbours.width), neighbours.width / 2);
  if (near == 0) return areas;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double radius = neighbours.distances_of(i)[near - 1];
    std::size_t count = 0;
    for (const std::uint32_t j : neighbours.of(i).first(near)) {
      const bool is_opposite = std::abs(normals[i].dot(normals[j])) >= k_alike_cosine &&
                               !on_one_surface(places[j] - places[i], normals[i], normals[j], noise);
      count += is_opposite ? 0 : 1;
    }
    areas[i] = std::numbers::pi * radius * radius / static_cast<double>(std::max<std::size_t>(count, 1));
  }
  return areas;
}

Patches grow_patches(const Points& places, const Points& normals, const NeighbourTable& neighbours, double noise,
                     std::size_t least, std::size_t most) {
  Patches patches{.of_point = std::vector<std::uint32_t>(places.size(), Patches::k_none),
                  .flipped = std::vector<char>(places.size(), 0),
                  .points = {}};
  std::vector<char> is_done(places.size(), 0);
  const std::size_t links = std::min(k_voters, neighbours.width);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t seed = 0; seed < places.size(); ++seed) {
    if (is_done[seed] != 0) continue;
    is_done[seed] = 1;
    patch.assign(1, seed);
    for (std::size_t next = 0; next < patch.size() && patch.size() < most; ++next) {
      for (const std::uint32_t j : neighbours.of(patch[next]).first(links)) {
        if (patch.size() == most) break;
        if (is_done[j] != 0) continue;
        if (!on_one_surface(places[j] - places[seed], normals[seed], normals[j], noise) ||
            !on_one_surface(places[j] - places[patch[next]], normals[patch[next]], normals[j], noise)) {
          continue;
        }
        is_done[j] = 1;
        patch.push_back(j);
      }
    }
    if (patch.size() < least) {
      // Other points may still belong to a patch with another seed.
      for (const std::uint32_t i : patch) is_done[i] = i == seed ? 1 : 0;
      continue;
    }
    for (const std::uint32_t i : patch) {
      patches.of_point[i] = static_cast<std::uint32_t>(patches.points.size());
      patches.flipped[i] = normals[i].dot(normals[seed]) < 0.0 ? 1 : 0;
    }
    patches.points.push_back(patch);
  }
  return patches;
}

PatchSigns find_patch_signs(const PatchFields& fields, std::span<const double> weights,
                            std::span<const PatchVote> votes, const RunContext& run) {
  Groups groups = GroupBuilder(fields.count, votes).build();
  SignSearch search(fields, weights, votes, groups);
  for (int turn = 0; turn < 8 * k_rounds && search.turn_best(); ++turn) run.throw_if_stopped();
  for (int sweep = 0; sweep < 2 * k_rounds && search.sweep(); ++sweep) run.throw_if_stopped();
  return {.flipped = search.flipped(), .windings = search.windings(), .body_of = std::move(groups.body_of)};
}

}  // namespace cloud2csg
