#include "solids/term_search.hpp"

#include <algorithm>
#include <numeric>

#include "solids/max_sum.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_polytope_seeds = 4;
constexpr std::size_t k_free_planes = 6;
constexpr double k_gain_floor = 1e-9;  // less is rounding

/// What is lost by having all places that are inside.
double positive_sum_of_losses(const RevolvedFamily& revolved, std::span<const double> gains) {
  double sum = 0;
  for (const std::uint32_t i : revolved.inside) sum += std::max(-gains[i], 0.0);
  return sum;
}

double price_of(const RevolvedFamily& revolved, const TermCosts& costs) {
  return revolved.known ? costs.known * costs.leaf : costs.leaf;
}

/// A curved surface's inside, or outside, and what it has in common with the best box or known solid.
PricedTerm best_with_box(const TermSpace& space, std::uint32_t family, bool is_inverted, std::span<const double> gains,
                         const TermCosts& costs, double least) {
  const RevolvedFamily& revolved = space.revolved[family];
  const std::uint8_t side = is_inverted ? 0 : 1;
  const double price = price_of(revolved, costs);
  PricedTerm best{.term = {}, .net = least};
  // No box alone is better than `least`: leaving out what is inside must gain more than that costs.
  if (is_inverted && positive_sum_of_losses(revolved, gains) <= price) return best;
  const TermPart curved{.kind = PartKind::revolved,
                        .family = family,
                        .ranges = {BinRange{0, revolved.bins.count() - 1}},
                        .planes = {},
                        .is_inverted = is_inverted,
                        .is_known = revolved.known.has_value()};
  std::vector<double> within(gains.size());
  for (std::size_t i = 0; i < gains.size(); ++i) within[i] = revolved.is_inside[i] == side ? gains[i] : 0.0;
  const double most = positive_sum(within) - costs.leaf - price;
  for (std::uint32_t boxes = 0; boxes < space.boxes.size() && most > best.net; ++boxes) {
    const PricedTerm box = best_box(space, boxes, within, costs, best.net + price);
    if (box.term.parts.empty()) continue;
    best.net = box.net - price;
    best.term.parts = {box.term.parts[0], curved};
    if (!is_inverted) std::swap(best.term.parts[0], best.term.parts[1]);
  }
  // Known solids come first among the curved surfaces, and stand for boxes, too.
  for (std::uint32_t k = 0; k < space.known.size(); ++k) {
    if (k == family) continue;
    const PricedTerm known = best_revolved(space, k, within, costs, best.net + price);
    if (known.term.parts.empty()) continue;
    best = {.term = {.parts = {known.term.parts[0], curved}}, .net = known.net - price};
  }
  return best;
}

/// Cuts planes around a seed, each the one that gains most. What each plane has on one side is summed once, and kept up
/// to date by what a cut takes away or leaves, whichever is less.
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

  /// Leaves the places on the seed's side of a plane.
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
  std::vector<double> under_;       // by plane: what they gain under it
  std::vector<std::uint32_t> alive_, taken_;
  std::vector<double> under_alive_;
};

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
  const BoxFamily& boxes = space.boxes[family];
  SumGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) grid.bins[axis] = boxes.bins[axis].count();
  grid.sums.assign(std::size_t{grid.bins[0]} * grid.bins[1] * grid.bins[2], 0.0);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const std::size_t row = std::size_t{boxes.bin_of_place[0][i]} * grid.bins[1] + boxes.bin_of_place[1][i];
    grid.sums[row * grid.bins[2] + boxes.bin_of_place[2][i]] += gains[i];
  }
  const double least_sum = least + costs.leaf;
  const BestBox best = max_sum_box(grid, least_sum);
  if (!(best.sum > least_sum)) return {.term = {}, .net = least};
  const TermPart part{
      .kind = PartKind::box, .family = family, .ranges = best.ranges, .planes = {}, .is_inverted = false};
  return {.term = {.parts = {part}}, .net = best.sum - costs.leaf};
}

PricedTerm best_revolved(const TermSpace& space, std::uint32_t family, std::span<const double> gains,
                         const TermCosts& costs, double least) {
  const RevolvedFamily& revolved = space.revolved[family];
  std::vector<double> sums(revolved.bins.count(), 0.0);
  for (std::size_t k = 0; k < revolved.inside.size(); ++k) sums[revolved.bin_of_inside[k]] += gains[revolved.inside[k]];
  const BestInterval best = max_sum_interval(sums);
  const double price = price_of(revolved, costs);
  if (!(best.sum - price > least)) return {.term = {}, .net = least};
  const TermPart part{.kind = PartKind::revolved,
                      .family = family,
                      .ranges = {best.range},
                      .planes = {},
                      .is_inverted = false,
                      .is_known = revolved.known.has_value()};
  return {.term = {.parts = {part}}, .net = best.sum - price};
}

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

PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs, double least,
                     TermKinds kinds) {
  PricedTerm best{.term = {}, .net = least};
  const double most = positive_sum(gains);
  const auto take = [&best](PricedTerm&& found) {
    if (!found.term.parts.empty() && found.net > best.net) best = std::move(found);
  };
  const double least_price = (space.known.empty() ? 1.0 : std::min(costs.known, 1.0)) * costs.leaf;
  if (most - least_price <= least) return best;
  for (std::uint32_t r = 0; r < space.revolved.size(); ++r) take(best_revolved(space, r, gains, costs, best.net));
  for (std::uint32_t b = 0; b < space.boxes.size(); ++b) take(best_box(space, b, gains, costs, best.net));
  if (kinds == TermKinds::simple) return best;
  if (space.has_oblique_planes) take(best_polytope(space, gains, costs, best.net));
  for (std::uint32_t r = 0; r < space.revolved.size(); ++r) {
    for (const bool is_inverted : {false, true}) take(best_with_box(space, r, is_inverted, gains, costs, best.net));
  }
  return best;
}

}  // namespace cloud2csg
