#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/run_context.hpp"
#include "raw/solids/term_search.hpp"

/// Decision lists: the first rule whose term has a place says whether it is in the solid; where none has, it is out.
namespace cloud2csg {

struct Rule {
  Term term = {};
  std::vector<std::uint8_t> members = {};  ///< by place of the term space
  bool is_in = true;
};

using DecisionList = std::vector<Rule>;

/// By place, the rule that decides; the list's size where none does.
[[nodiscard]] std::vector<std::uint16_t> deciding_rules(const DecisionList& list, std::size_t places);

/// What places lose that the list has wrong, plus the cost of its terms.
[[nodiscard]] double cost_of(const DecisionList& list, std::span<const double> pulls, const TermCosts& costs);

/// By rule, how much less the list costs without it. O(places x rules).
[[nodiscard]] std::vector<double> removal_savings(const DecisionList& list, std::span<const double> pulls,
                                                  const TermCosts& costs);

/// By place, what a new rule in front of rule `position` gains by having it.
[[nodiscard]] std::vector<double> insertion_gains(const DecisionList& list, std::span<const std::uint16_t> deciding,
                                                  std::span<const double> pulls, std::size_t position, bool is_in);

struct ListLimits {
  std::size_t rules = 0;
  /// Places times families that are priced, over all rules that are tried. Then no list is improved any more, and only
  /// simple terms are added. Counted, so that the result does not depend on the machine: some six seconds on one core.
  /// The largest part that was tried takes half of it. At half, such parts would lose rules; at double, a cloud that is
  /// not made of our surfaces takes twice the time.
  double work = 3e9;
};

/// A decision list of low cost: rules are put in where they gain most, one by one or two that only gain together, from
/// several starts; then each is taken out, or exchanged for what gains more, as long as the cost falls. Deterministic.
/// Stopped early, the best list so far.
[[nodiscard]] DecisionList search_list(const TermSpace& space, const TermCosts& costs, const ListLimits& limits,
                                       const RunContext& run = {});

}  // namespace cloud2csg
