#include "paper/objective/class_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace cloud2csg {
namespace {

/// Contributions in a cache line.
constexpr std::size_t k_line = 64 / sizeof(PackedContribution);

bool equal(const std::uint32_t* a, const std::uint32_t* b, std::size_t stride_b, std::size_t words) {
  for (std::size_t w = 0; w < words; ++w) {
    if (a[w] != b[w * stride_b]) return false;
  }
  return true;
}

bool equal(const BlockKeys& keys, std::size_t a, std::size_t b) {
  for (std::size_t w = 0; w < keys.count; ++w) {
    if (keys.words[w * k_block_points + a] != keys.words[w * k_block_points + b]) return false;
  }
  return true;
}

static_assert(RankClasses::k_shared_limit <= 32, "a member word has a bit a primitive");

const std::vector<PrimitiveIndex>& owners_of(const RankClassesRequest& request) {
  return request.owners.empty() ? request.primitives : request.owners;
}

bool are_same(const std::optional<AlignedBox>& a, const std::optional<AlignedBox>& b) {
  return a && b ? a->min() == b->min() && a->max() == b->max() : !a && !b;
}

/// Whether the root's classes can answer the request as well.
bool can_answer(const Root& root, const RankClassesRequest& request) {
  return root.primitives.size() <= RankClasses::k_shared_limit && root.stride == request.stride &&
         root.without_strangers == request.without_strangers && are_same(root.region, request.region) &&
         std::ranges::includes(root.primitives, request.primitives) &&
         std::ranges::includes(root.owners, owners_of(request));
}

std::size_t place_in(const Root& root, PrimitiveIndex primitive) {
  return static_cast<std::size_t>(std::ranges::lower_bound(root.primitives, primitive) - root.primitives.begin());
}

std::vector<std::size_t> places_in(const Root& root, const RankClassesRequest& request) {
  std::vector<std::size_t> places;
  for (const PrimitiveIndex p : request.primitives) places.push_back(place_in(root, p));
  return places;
}

/// Regroups the classes of a root, a block at a time, into the table of a subset.
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
  std::uint32_t unwanted_ = 0;  // inside bits that a class must not have
  std::uint32_t wanted_ = 0;    // member bits of which a class must have one; 0: takes every class
  KeyLayout layout_;
  std::vector<RankColumn> old_ranks_, new_ranks_;
  std::array<std::uint16_t, k_block_points> in_turn_{};
  std::array<std::uint32_t, k_block_points> chosen_{}, classes_{};
  std::size_t count_ = 0;
  ClassTable table_;
};

}  // namespace

std::size_t ClassTable::slot_of(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != 0 && !equal(&keys_[(slots_[slot] - 1) * words_], key, stride, words_))
    slot = (slot + 1) & mask;
  return slot;
}

void ClassTable::find_or_insert(const BlockKeys& keys, std::span<const std::uint16_t> points,
                                std::span<std::uint32_t> classes) {
  // The table exceeds the first-level cache: prefetch the slots of a whole block.
  for (const std::uint16_t i : points) __builtin_prefetch(&slots_[keys.hashes[i] & (slots_.size() - 1)]);
  for (std::size_t k = 0; k < points.size(); ++k) {
    classes[k] = find_or_insert(&keys.words[points[k]], k_block_points, keys.hashes[points[k]]);
    const std::span<const PackedContribution> sums = std::as_const(*this).row(classes[k]);
    for (std::size_t place = 0; place < row_; place += k_line) __builtin_prefetch(&sums[place], 1);
  }
}

std::uint32_t ClassTable::find_or_insert(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) {
  std::size_t slot = slot_of(key, stride, hash);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (2 * (size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(key, stride, hash);
  }
  const auto class_index = static_cast<std::uint32_t>(size());
  for (std::size_t w = 0; w < words_; ++w) keys_.push_back(key[w * stride]);
  if (class_index % k_page_rows == 0) pages_.emplace_back(k_page_rows * row_, 0U);
  hashes_.push_back(hash);
  pending_.push_back(0);
  wide_.push_back(0);
  slots_[slot] = class_index + 1;
  return class_index;
}

void ClassTable::grow() {
  slots_.assign(2 * slots_.size(), 0);
  for (std::size_t c = 0; c < size(); ++c) {
    slots_[slot_of(&keys_[c * words_], 1, hashes_[c])] = static_cast<std::uint32_t>(c + 1);
  }
}

void ClassTable::make_wide(std::size_t class_index) {
  if (has_wide(class_index)) return;
  wide_points_.push_back(0);
  wide_sums_.resize(wide_sums_.size() + row_);
  wide_[class_index] = static_cast<std::uint32_t>(wide_points_.size());
}

void ClassTable::widen(std::size_t class_index) {
  make_wide(class_index);
  wide_points_[wide_[class_index] - 1] += std::exchange(pending_[class_index], 0U);
  const std::span<PackedContribution> packed = row(class_index);
  const std::span<WideContribution> wide = wide_row(class_index);
  for (std::size_t k = 0; k < row_; ++k) wide[k] += widened(std::exchange(packed[k], 0U));
}

void ClassTable::add_class(std::size_t class_index, const ClassTable& other, std::size_t other_class,
                           std::span<const std::size_t> places) {
  const std::span<const PackedContribution> packed = other.row(other_class);
  const std::span<PackedContribution> sums = add_points(class_index, other.pending_[other_class]);
  for (std::size_t k = 0; k < places.size(); ++k) sums[k] += packed[places[k]];
  if (!other.has_wide(other_class)) return;
  make_wide(class_index);
  wide_points_[wide_[class_index] - 1] += other.wide_points_[other.wide_[other_class] - 1];
  const std::span<const WideContribution> added = other.wide_row(other_class);
  const std::span<WideContribution> wide = wide_row(class_index);
  for (std::size_t k = 0; k < places.size(); ++k) wide[k] += added[places[k]];
}

std::size_t ClassTable::point_count() const {
  const std::size_t packed = std::accumulate(pending_.begin(), pending_.end(), std::size_t{0});
  return std::accumulate(wide_points_.begin(), wide_points_.end(), packed);
}

void ClassTable::absorb(const ClassTable& other) {
  std::vector<std::size_t> same_places(row_);
  std::iota(same_places.begin(), same_places.end(), std::size_t{0});
  for (std::size_t c = 0; c < other.size(); ++c) {
    add_class(find_or_insert(other.key(c).data(), 1, other.hashes_[c]), other, c, same_places);
  }
}

std::size_t BlockGroups::slot_of(const BlockKeys& keys, std::uint16_t point) const {
  static_assert(std::has_single_bit(2 * k_block_points));
  constexpr std::size_t k_mask = 2 * k_block_points - 1;
  std::size_t slot = keys.hashes[point] & k_mask;
  while (slots_[slot] != 0 && !equal(keys, first_points_[slots_[slot] - 1U], point)) slot = (slot + 1) & k_mask;
  return slot;
}

void BlockGroups::group(const BlockKeys& keys, std::span<const std::uint16_t> points) {
  slots_.fill(0);
  size_ = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t slot = slot_of(keys, points[k]);
    if (slots_[slot] == 0) {
      first_points_[size_] = points[k];
      counts_[size_] = 0;
      slots_[slot] = static_cast<std::uint16_t>(++size_);
    }
    groups_[k] = static_cast<std::uint16_t>(slots_[slot] - 1U);
    ++counts_[groups_[k]];
  }
}

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
    // Search the shortest list of roots: a primitive that overlaps all others is in all of them.
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
