#include "raw/solids/list_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/base/run.hpp"

namespace cloud2csg {
namespace {

/// Weights of a first rule's losses. Below 1 they allow for later rules that repair them.
constexpr std::array k_starts{1.0, 0.5, 0.2};
/// The same for blocks of which most is cut away, each a quarter or a fifth of the last. Tried only while the best list
/// is poor, because they take longer.
constexpr std::array k_bold_starts{0.05, 0.01};
/// Cost of a poor list, where a list without rules costs 1.5. Two of 108 clouds with and without noise have such lists,
/// and both gain from bold starts. At half, twelve more would try them, and at double, one fewer.
constexpr double k_poor_cost = 0.1;
constexpr double k_hope = 0.3;         // weight of the losses of the first of two rules that only gain together
constexpr double k_least_gain = 1e-7;  // less is rounding
constexpr std::uint64_t k_repair_stage = 0x7265'7061'6972;
/// With 1, the lists of 33 parts cost .3 % more and take 9 % less time. With 6, they cost .9 % less and take 16 % more
/// time.
constexpr std::size_t k_repairs_a_rule = 3;
/// Two to four rules; one is what exchange_rules() does. With always two, the same lists cost .5 % more, with two to
/// seven .8 %.
constexpr std::size_t k_least_removed = 2;
constexpr std::size_t k_removed_choices = 3;
constexpr std::size_t k_most_sweeps = 20;
constexpr std::size_t k_large_work = 500'000;

std::size_t work_of(const TermSpace& space, TermKinds kinds = TermKinds::all) {
  const std::size_t single = space.revolved.size() + space.profiles.size();
  if (kinds != TermKinds::all) return space.size() * single;
  return space.size() * (space.planes.size() + single + 2 * space.revolved.size() * space.profiles.size());
}

struct Insertion {
  std::size_t position = 0;
  bool is_in = true;
  PricedTerm found = {};
};

struct Focus {
  TermKinds kinds = TermKinds::all;
  double hope = 1;  ///< below 1: weight of places' losses
  /// Places where gains count; null for all. Looking only where a removed rule was is much faster.
  const std::vector<std::uint8_t>* on = nullptr;
};

/// The positions to try for a new rule: in front, and behind each block of opposite rules. Behind an equal rule it
/// gains no more than in front of that rule. Positions within a block are left out for speed.
std::vector<std::size_t> insertion_positions(const DecisionList& list, bool is_in) {
  std::vector<std::size_t> positions{0};
  for (std::size_t r = 0; r < list.size(); ++r) {
    const bool differs = list[r].is_in != is_in;
    const bool is_last_of_block = r + 1 == list.size() || list[r + 1].is_in == is_in;
    if (differs && is_last_of_block) positions.push_back(r + 1);
  }
  // Behind the last rule, everything is out already.
  if (!is_in && positions.back() == list.size() && positions.size() > 1) positions.pop_back();
  return positions;
}

class ListSearch {
 public:
  ListSearch(const TermSpace& space, const TermCosts& costs, const ListLimits& limits, const RunContext& run)
      : space_(space), costs_(costs), limits_(limits), is_large_(work_of(space) > k_large_work), run_(run) {}

  DecisionList run() {
    best_cost_ = cost(best_);
    // A person who gives solids wants them in the tree, also where one profile would replace several.
    if (!space_.known.empty()) try_list(grown({}, limits_.rules, {.kinds = TermKinds::known}));
    for (const double hope : k_starts) try_start(hope);
    for (const double hope : k_bold_starts) {
      // Lists of large spaces are improved later, so their costs tell nothing yet.
      if (!is_large_ && best_cost_ > k_poor_cost) try_start(hope);
    }
    return is_large_ ? improved(std::move(best_)) : std::move(best_);
  }

  std::optional<DecisionList> run_from(DecisionList list) {
    for (Rule& rule : list) rule.members = members_of(space_, rule.term);
    const double before = cost(list);
    list = improved(pruned(grown(std::move(list), limits_.rules)));
    return cost(list) < before - k_least_gain ? std::optional(std::move(list)) : std::nullopt;
  }

 private:
  [[nodiscard]] bool is_over() const { return run_.stop.stop_requested() || spent_ > limits_.work; }

  [[nodiscard]] double cost(const DecisionList& list) const { return cost_of(list, space_.pulls, costs_); }

  [[nodiscard]] DecisionList with(const DecisionList& list, const Insertion& insertion) const {
    DecisionList result = list;
    result.insert(result.begin() + static_cast<std::ptrdiff_t>(insertion.position),
                  Rule{.term = insertion.found.term,
                       .members = members_of(space_, insertion.found.term),
                       .is_in = insertion.is_in});
    return result;
  }

  void apply(const Focus& focus, std::vector<double>& gains) const {
    for (std::size_t i = 0; i < gains.size(); ++i) {
      if (gains[i] < 0) gains[i] = summable(gains[i] * focus.hope);
      if (focus.on != nullptr && gains[i] > 0 && (*focus.on)[i] == 0) gains[i] = 0;
    }
  }

  /// Upper bounds by position on the gain of a rule inserted there.
  [[nodiscard]] std::vector<double> most_gains(const DecisionList& list, std::span<const std::uint16_t> deciding,
                                               bool is_in, const Focus& focus) const {
    std::vector<double> gains = insertion_gains(list, deciding, space_.pulls, 0, is_in);
    apply(focus, gains);
    std::vector<double> most(list.size() + 1, 0.0);
    for (std::size_t i = 0; i < gains.size(); ++i) most[deciding[i]] += std::max(gains[i], 0.0);
    for (std::size_t position = list.size(); position-- > 0;) most[position] += most[position + 1];
    return most;
  }

  [[nodiscard]] Insertion best_insertion(const DecisionList& list, const Focus& focus) {
    const std::vector<std::uint16_t> deciding = deciding_rules(list, space_.size());
    std::vector<Insertion> candidates;
    for (const bool is_in : {true, false}) {
      const std::vector<double> most = most_gains(list, deciding, is_in, focus);
      for (const std::size_t position : insertion_positions(list, is_in)) {
        if (most[position] > k_least_gain) candidates.push_back({.position = position, .is_in = is_in, .found = {}});
      }
    }
    if (candidates.empty()) return {};
    spent_ += static_cast<double>(candidates.size() * work_of(space_, focus.kinds));
    for_each_index(candidates.size(), without_stop(run_), [&](std::size_t c) {
      Insertion& candidate = candidates[c];
      std::vector<double> gains = insertion_gains(list, deciding, space_.pulls, candidate.position, candidate.is_in);
      apply(focus, gains);
      candidate.found = best_term(space_, gains, costs_, k_least_gain, focus.kinds, run_);
    });
    Insertion best = candidates[0];
    for (const Insertion& candidate : candidates) {
      if (best.found.term.parts.empty() ||
          (!candidate.found.term.parts.empty() && candidate.found.net > best.found.net)) {
        best = candidate;
      }
    }
    return best;
  }

  [[nodiscard]] DecisionList start(double hope) {
    const Insertion first = best_insertion({}, {.hope = hope});
    return first.found.term.parts.empty() ? DecisionList{} : with({}, first);
  }

  /// Leaves out a start that was tried already.
  void try_start(double hope) {
    if (run_.stop.stop_requested() || (!best_.empty() && is_over())) return;
    DecisionList list = start(hope);
    const Term first = list.empty() ? Term{} : list[0].term;
    if (std::ranges::find(tried_, first) != tried_.end()) return;
    tried_.push_back(first);
    try_list(std::move(list));
  }

  /// Keeps the list that grows from this one if it is the best so far.
  void try_list(DecisionList list) {
    list = pruned(grown(std::move(list), limits_.rules));
    if (!is_large_) list = improved(std::move(list));
    const double list_cost = cost(list);
    if (list_cost >= best_cost_ - k_least_gain) return;
    best_ = std::move(list);
    best_cost_ = list_cost;
  }

  /// Inserts rules while that gains.
  [[nodiscard]] DecisionList grown(DecisionList list, std::size_t most_more, const Focus& focus = {}) {
    for (std::size_t k = 0; k < most_more && list.size() < limits_.rules && !run_.stop.stop_requested(); ++k) {
      const Insertion insertion = next_insertion(list, focus);
      if (insertion.found.term.parts.empty()) break;
      list = with(list, insertion);
    }
    return list;
  }

  /// If all kinds are asked for, tries simple terms first in a large space, and nothing else once the work limit is
  /// reached.
  [[nodiscard]] Insertion next_insertion(const DecisionList& list, const Focus& focus) {
    if (focus.kinds != TermKinds::all) return best_insertion(list, focus);
    if (is_large_ || is_over()) {
      Focus simple = focus;
      simple.kinds = TermKinds::simple;
      Insertion insertion = best_insertion(list, simple);
      if (!insertion.found.term.parts.empty()) return insertion;
    }
    return is_over() ? Insertion{} : best_insertion(list, focus);
  }

  /// A losing rule and the rules that make up for it.
  [[nodiscard]] DecisionList grown_by_two(const DecisionList& list) {
    const Insertion hopeful = best_insertion(list, {.hope = k_hope});
    if (hopeful.found.term.parts.empty()) return list;
    return grown(with(list, hopeful), 2);
  }

  /// A rule to remove or to reduce to one of its parts.
  struct Reduction {
    std::size_t rule = 0;
    std::optional<std::size_t> part = {};
    double cost = 0;  ///< cost of the resulting list
  };

  /// Removes rules and parts that do not pay, the least useful first.
  [[nodiscard]] DecisionList pruned(DecisionList list) const {
    double now = cost(list);
    while (const std::optional<Reduction> best = best_reduction(list, now)) {
      if (best->part) {
        list[best->rule] = with_part_alone(list[best->rule], *best->part);
      } else {
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(best->rule));
      }
      now = best->cost;
    }
    return list;
  }

  /// Gain if a rule has additional members.
  [[nodiscard]] double gain_of_more(const DecisionList& list, std::span<const std::uint16_t> deciding, std::size_t rule,
                                    const std::vector<std::uint8_t>& members) const {
    double gain = 0;
    for (std::size_t i = 0; i < deciding.size(); ++i) {
      if (members[i] == 0 || deciding[i] <= rule) continue;
      const bool is_in = deciding[i] < list.size() && list[deciding[i]].is_in;
      if (is_in != list[rule].is_in) gain += is_in ? -space_.pulls[i] : space_.pulls[i];
    }
    return gain;
  }

  /// The reduction with the least cost; absent if all raise the cost.
  [[nodiscard]] std::optional<Reduction> best_reduction(const DecisionList& list, double now) const {
    std::optional<Reduction> best;
    double best_cost = now + k_least_gain;
    const auto consider = [&](const Reduction& reduction) {
      if (reduction.cost >= best_cost) return;
      best = reduction;
      best_cost = reduction.cost;
    };
    const std::vector<double> savings = removal_savings(list, space_.pulls, costs_);
    const std::vector<std::uint16_t> deciding = deciding_rules(list, space_.size());
    const auto useless = static_cast<std::size_t>(std::ranges::max_element(savings) - savings.begin());
    if (!list.empty()) consider({.rule = useless, .part = {}, .cost = now - savings[useless]});
    for (std::size_t r = 0; r < list.size(); ++r) {
      for (const std::size_t p : parts_that_can_stand_alone(list[r].term)) {
        const Rule alone = with_part_alone(list[r], p);
        const double saved = cost_of(list[r].term, costs_) - cost_of(alone.term, costs_);
        consider({.rule = r, .part = p, .cost = now - saved - gain_of_more(list, deciding, r, alone.members)});
      }
    }
    return best;
  }

  /// None for a term of one part.
  [[nodiscard]] static std::vector<std::size_t> parts_that_can_stand_alone(const Term& term) {
    std::vector<std::size_t> parts;
    for (std::size_t p = 0; p < term.parts.size() && term.parts.size() > 1; ++p) {
      if (!term.parts[p].is_inverted) parts.push_back(p);
    }
    return parts;
  }

  [[nodiscard]] static DecisionList without(const DecisionList& list, std::size_t rule) {
    DecisionList result = list;
    result.erase(result.begin() + static_cast<std::ptrdiff_t>(rule));
    return result;
  }

  [[nodiscard]] Rule with_part_alone(const Rule& rule, std::size_t part) const {
    Rule alone{.term = {.parts = {rule.term.parts[part]}}, .members = {}, .is_in = rule.is_in};
    alone.members = members_of(space_, alone.term);
    return alone;
  }

  [[nodiscard]] static std::vector<std::uint8_t> united(std::vector<std::uint8_t> a,
                                                        const std::vector<std::uint8_t>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] |= b[i];
    return a;
  }

  bool take(DecisionList&& other, DecisionList& list, double& now) {
    other = pruned(std::move(other));
    const double other_cost = cost(other);
    if (other_cost >= now - k_least_gain) return false;
    list = std::move(other);
    now = other_cost;
    run_.report("solids", ++improvements_, 0, "improvements");
    return true;
  }

  void exchange_rules(DecisionList& list, double& now) {
    for (std::size_t r = 0; r < list.size() && !is_over(); ++r) {
      const std::vector<std::uint8_t> members = list[r].members;
      if (take(grown(without(list, r), 2, {.on = &members}), list, now)) continue;
      for (const std::size_t p : parts_that_can_stand_alone(list[r].term)) {
        DecisionList alone = list;
        alone[r] = with_part_alone(list[r], p);
        const std::vector<std::uint8_t> on = alone[r].members;
        if (take(grown(alone, 2, {.on = &on}), list, now)) break;
      }
    }
  }

  /// Removes some rules at random, and grows simple ones where they were: large neighbourhood search (Shaw 1998). Rules
  /// that are best together are found, although each alone is not. Terms of all kinds would use up the work limit.
  void destroy_and_repair(DecisionList& list, double& now) {
    const std::size_t tries = k_repairs_a_rule * list.size();
    for (std::size_t k = 0; k < tries && !is_over(); ++k) {
      RandomStream random(0, k_repair_stage, k);
      const std::size_t count = std::min(k_least_removed + random.below(k_removed_choices), list.size());
      DecisionList rest = list;
      std::vector<std::uint8_t> on(space_.size());
      for (std::size_t removed = 0; removed < count; ++removed) {
        const std::size_t r = random.below(rest.size());
        if (std::ranges::any_of(rest[r].term.parts, &TermPart::is_known)) continue;  // a person wants it
        on = united(std::move(on), rest[r].members);
        rest = without(rest, r);
      }
      take(grown(std::move(rest), count + 2, {.kinds = TermKinds::simple, .on = &on}), list, now);
    }
  }

  [[nodiscard]] DecisionList improved(DecisionList list) {
    double now = cost(list);
    destroy_and_repair(list, now);
    for (std::size_t sweep = 0; sweep < k_most_sweeps && !is_over(); ++sweep) {
      const double before = now;
      take(grown(grown_by_two(list), limits_.rules), list, now);
      exchange_rules(list, now);
      if (now >= before - k_least_gain) break;
    }
    return list;
  }

  const TermSpace& space_;
  const TermCosts& costs_;
  const ListLimits& limits_;
  DecisionList best_ = {};
  double best_cost_ = 0;
  std::vector<Term> tried_ = {};  ///< first terms of the starts so far
  double spent_ = 0;              ///< work of all pricings so far
  std::size_t improvements_ = 0;
  bool is_large_;  ///< tries simple terms first, and improves only the best start
  const RunContext& run_;
};

}  // namespace

DecisionList search_list(const TermSpace& space, const TermCosts& costs, const ListLimits& limits,
                         const RunContext& run) {
  return ListSearch(space, costs, limits, run).run();
}

std::optional<DecisionList> improve_list(DecisionList list, const TermSpace& space, const TermCosts& costs,
                                         const ListLimits& limits, const RunContext& run) {
  return ListSearch(space, costs, limits, run).run_from(std::move(list));
}

}  // namespace cloud2csg
