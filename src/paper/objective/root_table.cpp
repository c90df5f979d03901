#include "paper/objective/root_table.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <unordered_map>

namespace cloud2csg {
namespace {

static_assert(RankClasses::k_shared_limit <= 32, "a member word has a bit a primitive");

const std::vector<PrimitiveIndex>& owners_of(const RankClassesRequest& request) {
  return request.owners.empty() ? request.primitives : request.owners;
}

bool are_same(const std::optional<AlignedBox>& a, const std::optional<AlignedBox>& b) {
  return a && b ? a->min() == b->min() && a->max() == b->max() : !a && !b;
}

/// Whether the root may be grouped by for the request as well.
bool can_answer(const Root& root, const RankClassesRequest& request) {
  return root.primitives.size() <= RankClasses::k_shared_limit && root.stride == request.stride &&
         root.without_strangers == request.without_strangers && are_same(root.region, request.region) &&
         std::ranges::includes(root.primitives, request.primitives) &&
         std::ranges::includes(root.owners, owners_of(request));
}

/// Where in the root's set a primitive is.
std::size_t place_in(const Root& root, PrimitiveIndex primitive) {
  return static_cast<std::size_t>(std::ranges::lower_bound(root.primitives, primitive) - root.primitives.begin());
}

std::vector<std::size_t> places_in(const Root& root, const RankClassesRequest& request) {
  std::vector<std::size_t> places;
  for (const PrimitiveIndex p : request.primitives) places.push_back(place_in(root, p));
  return places;
}

/// Takes the classes of a root, a block of them at a time, into the table of a subset.
class Projection {
 public:
  Projection(const Root& root, const ClassTable& from, std::span<const std::uint32_t> inside,
             const RankClassesRequest& request)
      : from_(from),
        inside_(inside),
        root_layout_(root.layout()),
        root_size_(root.primitives.size()),
        places_(places_in(root, request)),
        layout_(request.primitives.size()),
        old_ranks_(places_.size()),
        new_ranks_(places_.size()),
        table_(request.primitives.size(), layout_.words) {
    keys_.reshape(layout_.words);
    std::iota(in_turn_.begin(), in_turn_.end(), std::uint16_t{0});
    if (request.without_strangers) {
      unwanted_ = ~std::uint32_t{0};
      for (const std::size_t place : places_) unwanted_ &= ~(std::uint32_t{1} << place);
    }
    if (root.has_member_word && !request.all_points) {
      for (const PrimitiveIndex p : owners_of(request)) wanted_ |= std::uint32_t{1} << place_in(root, p);
    }
  }

  ClassTable run() {
    for (std::uint32_t c = 0; c < from_.size(); ++c) {
      if (wanted_ != 0 && (from_.key(c).back() & wanted_) == 0) continue;
      if ((inside_[c] & unwanted_) != 0) continue;
      chosen_[count_++] = c;
      if (count_ == k_block_points) take_block();
    }
    take_block();
    return std::move(table_);
  }

 private:
  void take_block() {
    for (std::size_t k = 0; k < places_.size(); ++k) decode(places_[k], old_ranks_[k]);
    std::vector<const RankColumn*> columns;
    for (const RankColumn& column : old_ranks_) columns.push_back(&column);
    compute_signed_ranks(columns, new_ranks_);
    pack_rank_keys(new_ranks_, layout_, keys_);
    compute_hashes(keys_);
    const std::span<std::uint32_t> classes = std::span(classes_).first(count_);
    table_.find_or_insert(keys_, std::span(in_turn_).first(count_), classes);
    for (std::size_t i = 0; i < count_; ++i) table_.add_class(classes[i], from_, chosen_[i], places_);
    count_ = 0;
  }

  void decode(std::size_t primitive, RankColumn& out) const {
    const KeyLayout::Place place = root_layout_.place_of(primitive);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::uint32_t code = place.code_in(from_.key(chosen_[i]));
      out.ranks[i] = static_cast<std::int8_t>(static_cast<int>(code) - static_cast<int>(root_size_));
    }
  }

  BlockKeys keys_;
  const ClassTable& from_;
  std::span<const std::uint32_t> inside_;
  KeyLayout root_layout_;
  std::size_t root_size_;
  std::vector<std::size_t> places_;
  std::uint32_t unwanted_ = 0;  // inside bits of which a class must have none
  std::uint32_t wanted_ = 0;    // member bits of which a class must have one; 0: takes every class
  KeyLayout layout_;
  std::vector<RankColumn> old_ranks_, new_ranks_;
  std::array<std::uint16_t, k_block_points> in_turn_{};
  std::array<std::uint32_t, k_block_points> chosen_{}, classes_{};
  std::size_t count_ = 0;
  ClassTable table_;
};

}  // namespace

std::vector<Root> plan_roots(std::span<const RankClassesRequest> requests) {
  std::vector<std::size_t> largest_first(requests.size());
  std::iota(largest_first.begin(), largest_first.end(), std::size_t{0});
  std::ranges::stable_sort(largest_first, std::ranges::greater(),
                           [&](std::size_t k) { return requests[k].primitives.size(); });
  std::vector<Root> roots;
  std::unordered_map<PrimitiveIndex, std::vector<std::size_t>> roots_with;
  for (const std::size_t k : largest_first) {
    const RankClassesRequest& request = requests[k];
    assert(!request.primitives.empty() && request.stride > 0 && std::ranges::is_sorted(request.primitives));
    assert(std::ranges::includes(request.primitives, owners_of(request)));
    // Of the lists of roots that could do, the shortest: a primitive that overlaps all others is in all.
    const PrimitiveIndex rarest =
        *std::ranges::min_element(request.primitives, {}, [&](PrimitiveIndex p) { return roots_with[p].size(); });
    const std::vector<std::size_t>& nearby = roots_with[rarest];
    const auto found = std::ranges::find_if(nearby, [&](std::size_t r) { return can_answer(roots[r], request); });
    std::size_t r = roots.size();
    if (found != nearby.end()) {
      r = *found;
    } else {
      roots.push_back({.primitives = request.primitives,
                       .owners = owners_of(request),
                       .stride = request.stride,
                       .without_strangers = request.without_strangers,
                       .region = request.region});
      for (const PrimitiveIndex p : request.primitives) roots_with[p].push_back(r);
    }
    roots[r].all_points = roots[r].all_points || request.all_points;
    roots[r].requests.push_back(k);
  }
  for (Root& root : roots) root.has_member_word = root.requests.size() > 1;
  return roots;
}

std::vector<std::uint32_t> inside_words(const Root& root, const ClassTable& classes) {
  const KeyLayout layout = root.layout();
  std::vector<std::uint32_t> words(classes.size(), 0);
  for (std::size_t k = 0; k < root.primitives.size(); ++k) {
    const KeyLayout::Place place = layout.place_of(k);
    for (std::size_t c = 0; c < classes.size(); ++c) {
      words[c] |= std::uint32_t{place.code_in(classes.key(c)) < root.primitives.size()} << k;
    }
  }
  return words;
}

ClassTable project(const Root& root, const ClassTable& classes, std::span<const std::uint32_t> inside,
                   const RankClassesRequest& request) {
  return Projection(root, classes, inside, request).run();
}

}  // namespace cloud2csg
