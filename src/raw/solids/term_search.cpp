#include "raw/solids/term_search.hpp"

#include <algorithm>
#include <numeric>

#include "raw/solids/max_sum.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_polytope_seeds = 4;
constexpr std::size_t k_free_planes = 6;
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

/// The bins with gaining places. Beyond them, a box only loses.
std::array<BinRange, 3> bins_that_gain(const BoxFamily& boxes, const Gains& gains) {
  std::array<BinRange, 3> ranges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<std::uint16_t>& bin = boxes.bin_of_place[axis];
    BinRange& range = ranges[axis];
    range = {.first = boxes.bins[axis].count() - 1, .last = 0};
    for (const std::uint32_t i : gains.positive) {
      range.first = std::min<std::uint32_t>(range.first, bin[i]);
      range.last = std::max<std::uint32_t>(range.last, bin[i]);
    }
  }
  return ranges;
}

SumGrid sums_within(const BoxFamily& boxes, const std::array<BinRange, 3>& ranges, const Gains& gains) {
  SumGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) grid.bins[axis] = ranges[axis].last - ranges[axis].first + 1;
  grid.sums.assign(std::size_t{grid.bins[0]} * grid.bins[1] * grid.bins[2], 0.0);
  for (const std::vector<std::uint32_t>* places : {&gains.positive, &gains.negative}) {
    for (const std::uint32_t i : *places) {
      // Values below the first bin wrap around to beyond the last.
      const std::uint32_t x = boxes.bin_of_place[0][i] - ranges[0].first;
      const std::uint32_t y = boxes.bin_of_place[1][i] - ranges[1].first;
      const std::uint32_t z = boxes.bin_of_place[2][i] - ranges[2].first;
      if (x >= grid.bins[0] || y >= grid.bins[1] || z >= grid.bins[2]) continue;
      grid.sums[(std::size_t{x} * grid.bins[1] + y) * grid.bins[2] + z] += gains.of_place[i];
    }
  }
  return grid;
}

PricedTerm best_box(const TermSpace& space, std::uint32_t family, const Gains& gains, const TermCosts& costs,
                    double least) {
  const double least_sum = least + costs.leaf;
  if (gains.positive_sum <= least_sum) return {.term = {}, .net = least};
  const BoxFamily& boxes = space.boxes[family];
  const std::array<BinRange, 3> within = bins_that_gain(boxes, gains);
  BestBox best = max_sum_box(sums_within(boxes, within, gains), least_sum);
  if (!(best.sum > least_sum)) return {.term = {}, .net = least};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    best.ranges[axis].first += within[axis].first;
    best.ranges[axis].last += within[axis].first;
  }
  const TermPart part{
      .kind = PartKind::box, .family = family, .ranges = best.ranges, .planes = {}, .is_inverted = false};
  return {.term = {.parts = {part}}, .net = best.sum - costs.leaf};
}

TermPart revolved_part(const TermSpace& space, std::uint32_t family, BinRange range) {
  return {.kind = PartKind::revolved,
          .family = family,
          .ranges = {range},
          .planes = {},
          .is_inverted = false,
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

/// The best intersection of a box with the inside or outside of a curved surface.
PricedTerm best_with_box(const TermSpace& space, std::uint32_t family, bool is_inverted, const Gains& gains,
                         const TermCosts& costs, double least) {
  const RevolvedFamily& revolved = space.revolved[family];
  const std::uint8_t side = is_inverted ? 0 : 1;
  const double price = price_of(revolved, costs);
  PricedTerm best{.term = {}, .net = least};
  if (sum_on_side(revolved, side, gains.positive, gains) - costs.leaf - price <= least) return best;
  // No box alone exceeds `least`, so excluding the inside must save more than its price.
  if (is_inverted && -sum_on_side(revolved, 1, gains.negative, gains) <= price) return best;
  TermPart curved = revolved_part(space, family, {.first = 0, .last = revolved.bins.count() - 1});
  curved.is_inverted = is_inverted;
  const Gains within = on_side(revolved, side, gains);
  for (std::uint32_t boxes = 0; boxes < space.boxes.size(); ++boxes) {
    const PricedTerm box = best_box(space, boxes, within, costs, best.net + price);
    if (box.term.parts.empty()) continue;
    best.net = box.net - price;
    best.term.parts = {box.term.parts[0], curved};
    if (!is_inverted) std::swap(best.term.parts[0], best.term.parts[1]);
  }
  return best;
}

/// A row a bin of a curved surface, a column a curved surface: total gain of the bin's places inside both. The
/// surface's own column has the bin's total.
std::vector<double> sums_with_others(const TermSpace& space, std::uint32_t family, const Gains& gains) {
  const RevolvedFamily& revolved = space.revolved[family];
  const std::size_t width = space.revolved.size();
  std::vector<double> sums(revolved.bins.count() * width, 0.0);
  for (std::size_t k = 0; k < revolved.inside.size(); ++k) {
    const double gain = gains.of_place[revolved.inside[k]];
    if (gain == 0) continue;
    const std::uint8_t* const __restrict is_inside = space.is_inside.data() + revolved.inside[k] * width;
    double* const __restrict row = sums.data() + revolved.bin_of_inside[k] * width;
    for (std::size_t other = 0; other < width; ++other) row[other] += is_inside[other] != 0 ? gain : 0.0;
  }
  return sums;
}

/// An interval of a curved surface, intersected with the inside or outside of another.
PricedTerm best_pair(const TermSpace& space, std::uint32_t family, const Gains& gains, const TermCosts& costs,
                     double least) {
  PricedTerm best{.term = {}, .net = least};
  const RevolvedFamily& revolved = space.revolved[family];
  const double price = price_of(revolved, costs);
  if (sum_on_side(revolved, 1, gains.positive, gains) - price - least_price(space, costs) <= least) return best;
  const std::vector<double> sums = sums_with_others(space, family, gains);
  const std::size_t width = space.revolved.size();
  std::vector<double> of_bin(revolved.bins.count());
  for (std::uint32_t other = 0; other < width; ++other) {
    if (other == family) continue;
    for (const bool is_inverted : {false, true}) {
      for (std::size_t bin = 0; bin < of_bin.size(); ++bin) {
        const double* const row = sums.data() + bin * width;
        of_bin[bin] = is_inverted ? row[family] - row[other] : row[other];
      }
      const BestInterval interval = max_sum_interval(of_bin);
      const double net = interval.sum - price - price_of(space.revolved[other], costs);
      if (net <= best.net) continue;
      TermPart whole = revolved_part(space, other, {.first = 0, .last = space.revolved[other].bins.count() - 1});
      whole.is_inverted = is_inverted;
      best = {.term = {.parts = {revolved_part(space, family, interval.range), whole}}, .net = net};
    }
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
    TermPart part{.kind = PartKind::polytope, .family = 0, .ranges = {}, .planes = {}, .is_inverted = false};
    double sum = sum_;
    while (cut(seed, part, sum)) {
    }
    if (part.planes.empty()) return {};
    const Term term{.parts = {part}};
    return {.term = term, .net = sum - cost_of(term, costs_)};
  }

 private:
  bool cut(std::size_t seed, TermPart& part, double& sum) {
    const double price = part.planes.size() < k_free_planes ? 0.0 : costs_.plane * costs_.leaf;
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
    if (!(open[seed] > 0) || positive_sum(open) - costs.leaf <= best.net) break;
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
    const std::size_t planes = part.planes.size();
    leaves += (part.is_known ? costs.known : 1.0) +
              (planes > k_free_planes ? costs.plane * static_cast<double>(planes - k_free_planes) : 0.0);
  }
  return leaves * costs.leaf;
}

PricedTerm best_box(const TermSpace& space, std::uint32_t family, std::span<const double> gains, const TermCosts& costs,
                    double least) {
  return best_box(space, family, all_of(gains), costs, least);
}

PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs, double least,
                     TermKinds kinds) {
  PricedTerm best{.term = {}, .net = least};
  const Gains all = all_of(gains);
  const auto take = [&best](PricedTerm&& found) {
    if (!found.term.parts.empty() && found.net > best.net) best = std::move(found);
  };
  if (all.positive_sum - least_price(space, costs) <= least) return best;
  for (std::uint32_t r = 0; r < space.revolved.size(); ++r) take(best_revolved(space, r, all, costs, best.net));
  for (std::uint32_t b = 0; b < space.boxes.size(); ++b) take(best_box(space, b, all, costs, best.net));
  if (kinds == TermKinds::simple) return best;
  if (space.has_oblique_planes) take(best_polytope(space, gains, costs, best.net));
  for (std::uint32_t r = 0; r < space.revolved.size(); ++r) {
    for (const bool is_inverted : {false, true}) take(best_with_box(space, r, is_inverted, all, costs, best.net));
    take(best_pair(space, r, all, costs, best.net));
  }
  return best;
}

}  // namespace cloud2csg
