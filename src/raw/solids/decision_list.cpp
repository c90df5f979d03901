#include "raw/solids/decision_list.hpp"

#include <cmath>

namespace cloud2csg {

std::vector<std::uint16_t> deciding_rules(const DecisionList& list, std::size_t places) {
  std::vector<std::uint16_t> deciding(places, static_cast<std::uint16_t>(list.size()));
  // __restrict allows vectorisation, because bytes may alias anything. This loop is half of a search's time.
  std::uint16_t* const __restrict rule_of = deciding.data();
  for (std::size_t r = list.size(); r-- > 0;) {
    const std::uint8_t* const __restrict is_member = list[r].members.data();
    const auto rule = static_cast<std::uint16_t>(r);
    for (std::size_t i = 0; i < places; ++i) rule_of[i] = is_member[i] != 0 ? rule : rule_of[i];
  }
  return deciding;
}

double cost_of(const DecisionList& list, std::span<const double> pulls, const TermCosts& costs) {
  const std::vector<std::uint16_t> deciding = deciding_rules(list, pulls.size());
  double cost = 0;
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    const bool is_in = deciding[i] < list.size() && list[deciding[i]].is_in;
    if (is_in != (pulls[i] > 0)) cost += std::abs(pulls[i]);
  }
  for (const Rule& rule : list) cost += cost_of(rule.term, costs);
  return cost;
}

std::vector<double> removal_savings(const DecisionList& list, std::span<const double> pulls, const TermCosts& costs) {
  const std::size_t none = list.size();
  std::vector<std::uint16_t> deciding(pulls.size(), static_cast<std::uint16_t>(none));
  std::vector<std::uint16_t> next(deciding);
  for (std::size_t r = none; r-- > 0;) {
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      if (list[r].members[i] == 0) continue;
      next[i] = deciding[i];
      deciding[i] = static_cast<std::uint16_t>(r);
    }
  }
  std::vector<double> savings(none);
  for (std::size_t r = 0; r < none; ++r) savings[r] = cost_of(list[r].term, costs);
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    if (deciding[i] == none) continue;
    const bool is_in = list[deciding[i]].is_in;
    const bool would_be_in = next[i] < none && list[next[i]].is_in;
    if (is_in != would_be_in) savings[deciding[i]] += would_be_in ? pulls[i] : -pulls[i];
  }
  return savings;
}

std::vector<double> insertion_gains(const DecisionList& list, std::span<const std::uint16_t> deciding,
                                    std::span<const double> pulls, std::size_t position, bool is_in) {
  std::vector<double> gains(pulls.size(), 0.0);
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    const bool is_in_now = deciding[i] < list.size() && list[deciding[i]].is_in;
    if (deciding[i] >= position && is_in_now != is_in) gains[i] = is_in ? pulls[i] : -pulls[i];
  }
  return gains;
}

}  // namespace cloud2csg
