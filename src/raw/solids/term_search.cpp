#include "raw/solids/term_search.hpp"

#include <algorithm>
#include <numeric>

#include "core/primitive/price.hpp"
#include "raw/solids/max_sum.hpp"
#include "raw/solids/outline.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_polytope_seeds = 4;
constexpr double k_gain_floor = 1e-9;  // less is rounding

/// Gains by place, and the places where they are not zero.
struct Gains {
  std::span<const double> of_place;
  std::vector<std::uint32_t> positive = {}, negative = {};
  double positive_sum = 0;  ///< no term gains more

  void add(std::uint32_t place) {
    const double gain = of_place[place];
    if (gain > 0) {
      positive.push_back(place);
      positive_sum += gain;
    } else if (gain < 0) {
      negative.push_back(place);
    }
  }
};

Gains all_of(std::span<const double> gains) {
  Gains all{.of_place = gains};
  for (std::uint32_t i = 0; i < gains.size(); ++i) all.add(i);
  return all;
}

/// The sum of gains over those places that are on one side of a curved surface.
double sum_on_side(const RevolvedFamily& revolved, std::uint8_t side, const std::vector<std::uint32_t>& places,
                   const Gains& gains) {
  double sum = 0;
  for (const std::uint32_t i : places) sum += revolved.is_inside[i] == side ? gains.of_place[i] : 0.0;
  return sum;
}

Gains on_side(const RevolvedFamily& revolved, std::uint8_t side, const Gains& gains) {
  Gains part{.of_place = gains.of_place};
  for (const std::vector<std::uint32_t>* places : {&gains.positive, &gains.negative}) {
    for (const std::uint32_t i : *places) {
      if (revolved.is_inside[i] == side) part.add(i);
    }
  }
  return part;
}

double price_of(const RevolvedFamily& revolved, const TermCosts& costs) {
  return revolved.known ? costs.known * costs.leaf : costs.leaf;
}

double least_price(const TermSpace& space, const TermCosts& costs) {
  return space.known.empty() ? costs.leaf : std::min(costs.known, 1.0) * costs.leaf;
}

TermPart revolved_part(const TermSpace& space, std::uint32_t family, BinRange range) {
  return {.kind = PartKind::revolved,
          .family = family,
          .range = range,
          .is_known = space.revolved[family].known.has_value()};
}

PricedTerm best_revolved(const TermSpace& space, std::uint32_t family, const Gains& gains, const TermCosts& costs,
                         double least) {
  const RevolvedFamily& revolved = space.revolved[family];
  const double price = price_of(revolved, costs);
  if (sum_on_side(revolved, 1, gains.positive, gains) - price <= least) return {.term = {}, .net = least};
  std::vector<double> sums(revolved.bins.count(), 0.0);
  for (std::size_t k = 0; k < revolved.inside.size(); ++k) {
    sums[revolved.bin_of_inside[k]] += gains.of_place[revolved.inside[k]];
  }
  const BestInterval best = max_sum_interval(sums);
  if (!(best.sum - price > least)) return {.term = {}, .net = least};
  return {.term = {.parts = {revolved_part(space, family, best.range)}}, .net = best.sum - price};
}

constexpr std::size_t k_tried_intervals = 10;

/// Gains by face, of all places below each edge of the slabs: a row an edge.
std::vector<double> sums_below(const ProfileFamily& family, std::size_t faces, const Gains& gains) {
  std::vector<double> sums(faces * (family.slabs.count() + 1), 0.0);
  for (const std::vector<std::uint32_t>* places : {&gains.positive, &gains.negative}) {
    for (const std::uint32_t i : *places) {
      sums[(family.slab_of_place[i] + std::size_t{1}) * faces + family.face_of_place[i]] += gains.of_place[i];
    }
  }
  for (std::size_t k = faces; k < sums.size(); ++k) sums[k] += sums[k - faces];
  return sums;
}

struct PromisingInterval {
  BinRange range;
  double bound;  ///< no set of faces gains more
};

std::vector<PromisingInterval> promising_intervals(const ProfileFamily& family, std::size_t faces,
                                                   std::span<const double> sums, double least) {
  std::vector<PromisingInterval> intervals;
  const std::uint32_t slabs = family.slabs.count();
  const bool is_turned = family.chart.is_turned;
  for (std::uint32_t first = is_turned ? 0 : 1; first < slabs; ++first) {
    for (std::uint32_t last = first; last + (is_turned ? 0 : 1) < slabs; ++last) {
      double bound = 0;
      for (std::size_t f = 1; f < faces; ++f) {
        bound += std::max(sums[(last + std::size_t{1}) * faces + f] - sums[first * faces + f], 0.0);
      }
      if (bound > least) intervals.push_back({.range = {first, last}, .bound = bound});
    }
  }
  std::ranges::stable_sort(intervals, std::greater<>(), &PromisingInterval::bound);
  intervals.resize(std::min(intervals.size(), k_tried_intervals));
  return intervals;
}

PricedTerm best_profile(const TermSpace& space, std::uint32_t index, const Gains& gains, const TermCosts& costs,
                        double least, const RunContext& run) {
  PricedTerm best{.term = {}, .net = least};
  if (gains.positive_sum <= least + costs.leaf) return best;
  const ProfileFamily& family = space.profiles[index];
  const std::size_t faces = family.chart.drawing.arrangement.areas.size();
  const std::vector<double> sums = sums_below(family, faces, gains);
  for (const PromisingInterval& interval : promising_intervals(family, faces, sums, least + costs.leaf)) {
    if (interval.bound - costs.leaf <= best.net || run.stop.stop_requested()) break;
    const auto [first, last] = interval.range;
    const double size = family.size_of(interval.range);
    const double unit = size * family.bare_price * costs.leaf;  // gain that one of the drawing's prices costs
    std::vector<double> face_gains(faces, 0.0);
    for (std::size_t f = 1; f < faces; ++f) {
      face_gains[f] = (sums[(last + std::size_t{1}) * faces + f] - sums[first * faces + f]) / unit;
    }
    TermPart part{.kind = PartKind::profile, .family = index, .range = interval.range};
    part.faces = choose_faces(family.chart.drawing, face_gains, k_segment_price * costs.leaf / unit, run);
    part.segments = segments_of(family.chart.drawing, part.faces);
    if (part.segments == 0) continue;
    part.bare_leaves = size * family.bare_price * border_price(family.chart.drawing, part.faces);
    double gain = 0;
    for (std::size_t f = 1; f < faces; ++f) gain += part.faces[f] != 0 ? unit * face_gains[f] : 0.0;
    PricedTerm found{.term = {.parts = {std::move(part)}}};
    found.net = gain - cost_of(found.term, costs);
    if (found.net > best.net && is_writable(family.chart.drawing, found.term.parts[0].faces)) best = std::move(found);
  }
  return best;
}

/// The best intersection of a profile with the inside or outside of a curved surface.
PricedTerm best_with_profile(const TermSpace& space, std::uint32_t family, bool is_inverted, const Gains& gains,
                             const TermCosts& costs, double least, const RunContext& run) {
  const RevolvedFamily& revolved = space.revolved[family];
  const std::uint8_t side = is_inverted ? 0 : 1;
  const double price = price_of(revolved, costs);
  PricedTerm best{.term = {}, .net = least};
  if (sum_on_side(revolved, side, gains.positive, gains) - costs.leaf - price <= least) return best;
  if (is_inverted && -sum_on_side(revolved, 1, gains.negative, gains) <= price) return best;
  TermPart curved = revolved_part(space, family, {.first = 0, .last = revolved.bins.count() - 1});
  curved.is_inverted = is_inverted;
  const Gains within = on_side(revolved, side, gains);
  for (std::uint32_t p = 0; p < space.profiles.size(); ++p) {
    const PricedTerm profile = best_profile(space, p, within, costs, best.net + price, run);
    if (profile.term.parts.empty()) continue;
    best.net = profile.net - price;
    best.term.parts = {profile.term.parts[0], curved};
    if (!is_inverted) std::swap(best.term.parts[0], best.term.parts[1]);
  }
  return best;
}

/// Greedily cuts with planes around a seed. Keeps the sum on one side of each plane, and updates it by the places that
/// a cut removes or leaves, whichever are fewer.
class PolytopeCuts {
 public:
  PolytopeCuts(const TermSpace& space, std::span<const double> gains, const TermCosts& costs)
      : space_(space), gains_(gains), costs_(costs), sum_(std::accumulate(gains.begin(), gains.end(), 0.0)) {
    for (std::uint32_t i = 0; i < gains.size(); ++i) {
      if (gains[i] != 0) all_.push_back(i);
    }
    for (std::uint32_t p = 0; p < space.planes.size(); ++p) under_.push_back(sum_under(p, all_));
  }

  PricedTerm around(std::size_t seed) {
    alive_ = all_;
    under_alive_ = under_;
    TermPart part;
    double sum = sum_;
    while (cut(seed, part, sum)) {
    }
    if (part.planes.empty()) return {};
    const Term term{.parts = {part}};
    return {.term = term, .net = sum - cost_of(term, costs_)};
  }

 private:
  bool cut(std::size_t seed, TermPart& part, double& sum) {
    const std::size_t planes = part.planes.size();
    const double price = (price_of_planes(planes + 1) - price_of_planes(planes)) * costs_.leaf;
    double best = price + k_gain_floor;
    std::uint32_t best_side = 0;
    bool found = false;
    for (std::uint32_t p = 0; p < space_.planes.size(); ++p) {
      const bool is_under = space_.planes[p].is_under[seed] != 0;
      const double lost = is_under ? sum - under_alive_[p] : under_alive_[p];
      if (-lost <= best) continue;
      best = -lost;
      best_side = 2 * p + (is_under ? 0U : 1U);
      found = true;
    }
    if (!found) return false;
    take_away(seed, best_side / 2);
    part.planes.push_back(best_side);
    sum += best;
    return true;
  }

  /// Keeps the places on the seed's side of a plane.
  void take_away(std::size_t seed, std::uint32_t plane) {
    const std::vector<std::uint8_t>& under = space_.planes[plane].is_under;
    const auto is_left = [&](std::uint32_t i) { return under[i] == under[seed]; };
    const auto middle = std::stable_partition(alive_.begin(), alive_.end(), is_left);
    taken_.assign(middle, alive_.end());
    alive_.erase(middle, alive_.end());
    const bool is_shorter = taken_.size() < alive_.size();
    for (std::uint32_t p = 0; p < space_.planes.size(); ++p) {
      under_alive_[p] = is_shorter ? under_alive_[p] - sum_under(p, taken_) : sum_under(p, alive_);
    }
  }

  [[nodiscard]] double sum_under(std::uint32_t plane, const std::vector<std::uint32_t>& places) const {
    const std::uint8_t* const under = space_.planes[plane].is_under.data();
    double sum = 0;
    for (const std::uint32_t i : places) sum += under[i] != 0 ? gains_[i] : 0.0;
    return sum;
  }

  const TermSpace& space_;
  std::span<const double> gains_;
  const TermCosts& costs_;
  double sum_;
  std::vector<std::uint32_t> all_;  // places that gain or lose
  std::vector<double> under_;       // by plane: the gain under it
  std::vector<std::uint32_t> alive_, taken_;
  std::vector<double> under_alive_;
};

PricedTerm best_polytope(const TermSpace& space, std::span<const double> gains, const TermCosts& costs, double least) {
  PricedTerm best{.term = {}, .net = least};
  std::vector<double> open(gains.begin(), gains.end());
  PolytopeCuts cuts(space, gains, costs);
  for (std::size_t k = 0; k < k_polytope_seeds; ++k) {
    const auto seed = static_cast<std::size_t>(std::ranges::max_element(open) - open.begin());
    if (!(open[seed] > 0) || all_of(open).positive_sum - costs.leaf <= best.net) break;
    PricedTerm found = cuts.around(seed);
    open[seed] = 0;
    if (found.term.parts.empty()) continue;
    const std::vector<std::uint8_t> members = members_of(space, found.term);
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = members[i] != 0 ? 0.0 : open[i];
    if (found.net > best.net) best = std::move(found);
  }
  return best;
}

}  // namespace

double cost_of(const Term& term, const TermCosts& costs) {
  double leaves = 0;
  for (const TermPart& part : term.parts) {
    leaves += price_of_segments(part.segments) + part.bare_leaves;
    leaves += (part.is_known ? costs.known : 1.0) + price_of_planes(part.planes.size());
  }
  return leaves * costs.leaf;
}

PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs, double least,
                     TermKinds kinds, const RunContext& run) {
  PricedTerm best{.term = {}, .net = least};
  const Gains all = all_of(gains);
  const auto take = [&best](PricedTerm&& found) {
    if (!found.term.parts.empty() && found.net > best.net) best = std::move(found);
  };
  if (all.positive_sum - least_price(space, costs) <= least) return best;
  const auto families = static_cast<std::uint32_t>(space.revolved.size());
  for (std::uint32_t r = 0; r < families; ++r) {
    if (kinds == TermKinds::known && !space.revolved[r].known) continue;
    take(best_revolved(space, r, all, costs, best.net));
  }
  if (kinds == TermKinds::known) return best;
  for (std::uint32_t p = 0; p < space.profiles.size(); ++p) take(best_profile(space, p, all, costs, best.net, run));
  if (kinds == TermKinds::simple || run.stop.stop_requested()) return best;
  take(best_polytope(space, gains, costs, best.net));
  for (std::uint32_t r = 0; r < families; ++r) {
    for (const bool is_inverted : {false, true})
      take(best_with_profile(space, r, is_inverted, all, costs, best.net, run));
  }
  return best;
}

}  // namespace cloud2csg
