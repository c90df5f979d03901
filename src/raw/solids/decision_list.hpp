#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raw/solids/term_search.hpp"

/// Decision lists: the first rule whose term contains a place decides whether it is in the solid. By default it is out.
namespace cloud2csg {

struct Rule {
  Term term = {};
  std::vector<std::uint8_t> members = {};  ///< by place of the term space
  bool is_in = true;
};

using DecisionList = std::vector<Rule>;

/// The deciding rule of each place; list.size() for none.
[[nodiscard]] std::vector<std::uint16_t> deciding_rules(const DecisionList& list, std::size_t places);

/// Sum of |pull| over wrongly decided places, plus the cost of the terms.
[[nodiscard]] double cost_of(const DecisionList& list, std::span<const double> pulls, const TermCosts& costs);

/// Savings in cost by removing each rule. O(places x rules).
[[nodiscard]] std::vector<double> removal_savings(const DecisionList& list, std::span<const double> pulls,
                                                  const TermCosts& costs);

/// Gain of each place from a new rule in front of rule `position` that contains it.
[[nodiscard]] std::vector<double> insertion_gains(const DecisionList& list, std::span<const std::uint16_t> deciding,
                                                  std::span<const double> pulls, std::size_t position, bool is_in);

}  // namespace cloud2csg
