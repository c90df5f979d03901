#include "raw/solids/term_ends.hpp"

#include <cstdint>
#include <utility>

namespace cloud2csg {
namespace {

const TermPart k_everything{.kind = PartKind::polytope};

std::vector<std::uint8_t> decisions_of(const DecisionList& list, std::size_t places) {
  const std::vector<std::uint16_t> deciding = deciding_rules(list, places);
  std::vector<std::uint8_t> is_in(places);
  for (std::size_t i = 0; i < places; ++i) {
    is_in[i] = deciding[i] < list.size() && list[deciding[i]].is_in ? 1 : 0;
  }
  return is_in;
}

/// The ends of a sector are not drawn in.
bool has_ends(const TermSpace& space, const TermPart& part) {
  return part.kind == PartKind::revolved ||
         (part.kind == PartKind::profile && !space.profiles[part.family].chart.is_turned);
}

void set_term(const TermSpace& space, Rule& rule, const Term& term) {
  rule.term = term;
  rule.members = members_of(space, term);
}

/// Moves the ends of all parts inward as long as the list decides all places as before. Where a rule that subtracts can
/// do so from everything instead of its first part, it does.
class DrawnIn {
 public:
  static DecisionList of(const TermSpace& space, DecisionList list) {
    DrawnIn drawn(space, std::move(list));
    for (std::size_t r = 0; r < drawn.list_.size(); ++r) {
      const std::size_t first = drawn.try_everything(r) ? 1 : 0;
      for (std::size_t p = first; p < drawn.list_[r].term.parts.size(); ++p) drawn.draw_in(r, p);
    }
    return std::move(drawn.list_);
  }

 private:
  DrawnIn(const TermSpace& space, DecisionList list)
      : space_(space), list_(std::move(list)), wanted_(decisions_of(list_, space.size())) {}

  void draw_in(std::size_t rule, std::size_t part) {
    if (!has_ends(space_, list_[rule].term.parts[part])) return;
    while (try_shorter(rule, part, 1, 0)) {
    }
    while (try_shorter(rule, part, 0, 1)) {
    }
  }

  bool try_shorter(std::size_t rule, std::size_t part, std::uint32_t at_first, std::uint32_t at_last) {
    Term moved = list_[rule].term;
    BinRange& range = moved.parts[part].range;
    if (range.first == range.last) return false;
    range = {range.first + at_first, range.last - at_last};
    return try_term(rule, moved);
  }

  bool try_everything(std::size_t rule) {
    if (list_[rule].is_in || list_[rule].term.parts.size() != 2) return false;
    Term wide = list_[rule].term;
    wide.parts[0] = k_everything;
    return try_term(rule, wide);
  }

  bool try_term(std::size_t rule, const Term& term) {
    const Term kept = list_[rule].term;
    set_term(space_, list_[rule], term);
    if (decisions_of(list_, space_.size()) == wanted_) return true;
    set_term(space_, list_[rule], kept);
    return false;
  }

  const TermSpace& space_;
  DecisionList list_;
  std::vector<std::uint8_t> wanted_;
};

/// Finds ends that may lie anywhere in the next bin. Any choice of such ends must leave all decisions unchanged. So a
/// place that enters or leaves one rule's term must not depend on that rule, nor enter or leave another rule's term.
class FreeEnds {
 public:
  /// By rule and part.
  static std::vector<std::vector<Overshoots>> of(const TermSpace& space, const DecisionList& list) {
    FreeEnds ends(space, list);
    std::vector<std::vector<Overshoots>> result;
    for (std::size_t r = 0; r < list.size(); ++r) {
      const std::vector<std::uint8_t> is_free = ends.places_that_do_not_depend_on(r);
      std::vector<Overshoots>& of_parts = result.emplace_back(list[r].term.parts.size());
      for (std::size_t p = 0; p < of_parts.size(); ++p) {
        if (!has_ends(space, list[r].term.parts[p])) continue;
        for (std::size_t end = 0; end < 2; ++end) of_parts[p][end] = ends.free(r, p, end, is_free);
      }
    }
    return result;
  }

 private:
  FreeEnds(const TermSpace& space, const DecisionList& list) : space_(space), list_(list), owners_(space.size(), 0) {
    for (const Rule& rule : list) longest_.push_back(rule.term);
  }

  [[nodiscard]] std::vector<std::uint8_t> places_that_do_not_depend_on(std::size_t rule) const {
    DecisionList list = list_;
    list[rule].members.assign(space_.size(), 1);
    std::vector<std::uint8_t> result = decisions_of(list, space_.size());
    list[rule].members.assign(space_.size(), 0);
    const std::vector<std::uint8_t> without = decisions_of(list, space_.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = result[i] == without[i] ? 1 : 0;
    return result;
  }

  bool free(std::size_t rule, std::size_t part, std::size_t end, const std::vector<std::uint8_t>& is_free) {
    const TermPart& exact = list_[rule].term.parts[part];
    const BinRange range = exact.range;
    if (end == 0 ? range.first == 0 : range.last + 1 == bins_of(space_, exact).count()) return false;
    TermPart moved = exact;
    lengthen(moved.range, end);
    if (!reaches_other_places(exact, moved)) return false;
    Term longer = longest_[rule];
    lengthen(longer.parts[part].range, end);
    const std::vector<std::uint32_t> changing = places_that_change(list_[rule].term, longer);
    for (const std::uint32_t i : changing) {
      if (is_free[i] == 0 || (owners_[i] != 0 && owners_[i] != rule + 1)) return false;
    }
    for (const std::uint32_t i : changing) owners_[i] = static_cast<std::uint32_t>(rule + 1);
    longest_[rule] = std::move(longer);
    return true;
  }

  static void lengthen(BinRange& range, std::size_t end) {
    if (end == 0)
      --range.first;
    else
      ++range.last;
  }

  /// Places whose membership in the term depends on the lengths of its parts.
  [[nodiscard]] std::vector<std::uint32_t> places_that_change(const Term& exact, const Term& longest) const {
    Term most = longest;
    Term least = exact;
    for (std::size_t p = 0; p < exact.parts.size(); ++p) {
      if (exact.parts[p].is_inverted) std::swap(most.parts[p], least.parts[p]);
    }
    const std::vector<std::uint8_t> in_most = members_of(space_, most);
    const std::vector<std::uint8_t> in_least = members_of(space_, least);
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < in_most.size(); ++i) {
      if (in_most[i] != in_least[i]) places.push_back(i);
    }
    return places;
  }

  /// Nothing is known about a bin without places.
  [[nodiscard]] bool reaches_other_places(TermPart a, TermPart b) const {
    a.is_inverted = false;
    b.is_inverted = false;
    return members_of(space_, {.parts = {a}}) != members_of(space_, {.parts = {b}});
  }

  const TermSpace& space_;
  const DecisionList& list_;
  std::vector<Term> longest_;          ///< by rule, with all free ends one bin farther
  std::vector<std::uint32_t> owners_;  ///< by place: the rule, from 1, whose term it may enter or leave
};

}  // namespace

const Bins& bins_of(const TermSpace& space, const TermPart& part) {
  return part.kind == PartKind::profile ? space.profiles[part.family].slabs : space.revolved[part.family].bins;
}

bool keeps_one_part(const Rule& rule) {
  return !rule.is_in && rule.term.parts.size() == 2 && rule.term.parts[0] == k_everything;
}

DecisionList drawn_in(const TermSpace& space, DecisionList list) {
  return DrawnIn::of(space, std::move(list));
}

std::vector<std::vector<Overshoots>> free_ends(const TermSpace& space, const DecisionList& list) {
  return FreeEnds::of(space, list);
}

}  // namespace cloud2csg
