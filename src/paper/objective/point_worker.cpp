#include "paper/objective/point_worker.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/base/run.hpp"
#include "paper/objective/class_table.hpp"

namespace cloud2csg {
namespace {

/// The points begin .. begin + count - 1 whose place is a multiple of the stride.
BlockMask every_kth(std::size_t begin, std::size_t count, std::size_t stride) {
  if (stride == 1) return first_points(count);
  BlockMask mask{};
  for (std::size_t i = (stride - begin % stride) % stride; i < count; i += stride) add_point(mask, i);
  return mask;
}

/// A primitive that is evaluated in a block.
template <class Real>
struct ActivePrimitive {
  BlockContributions<Real> contributions;
  BlockField<Real> field;
  PrimitiveIndex primitive = 0;
  bool has_members = false;  ///< points of the block belong to it
};

template <class Real>
class Worker {
 public:
  explicit Worker(const WorkerInput<Real>& input)
      : input_(input),
        blocks_(input.cloud, input.box, input.order),
        slot_of_(input.primitives.size(), k_none),
        is_wanted_(input.roots.size(), false),
        looks_at_bounds_(!input.reach.empty() ||
                         std::ranges::any_of(input.roots, [](const Root& root) { return root.region.has_value(); })) {
    share_.points_of_primitive.resize(input.primitives.size());
    std::size_t most_primitives = 0;
    for (const Root& root : input.roots) {
      share_.tables.emplace_back(root.primitives.size(), root.key_words());
      most_primitives = std::max(most_primitives, root.primitives.size());
    }
    ranks_.resize(most_primitives);
    if (input.reach.empty()) {
      near_chunk_.resize(input.primitives.size());
      std::iota(near_chunk_.begin(), near_chunk_.end(), PrimitiveIndex{0});
    }
  }

  void process(std::size_t chunk) {
    Stopwatch watch;
    blocks_.load(chunk);
    if (!input_.reach.empty()) look_around();
    for (std::size_t block = 0; block < blocks_.count(); ++block) {
      segment(block);
      choose_roots();
      for (const std::uint32_t k : wanted_) {
        for (const PrimitiveIndex p : input_.roots[k].primitives) evaluate(p, block);
      }
      share_.segment_seconds += watch.lap();
      const std::size_t begin = chunk * k_chunk_points + block * k_block_points;
      for (const std::uint32_t k : wanted_) group(k, block, begin);
      forget_block();
      share_.classes_seconds += watch.lap();
    }
  }

  [[nodiscard]] WorkerShare& share() { return share_; }

 private:
  static constexpr std::uint32_t k_none = static_cast<std::uint32_t>(-1);

  /// Finds the primitives that points of the chunk may belong to.
  void look_around() {
    const AlignedBox box = blocks_.bounds();
    near_chunk_.clear();
    for (PrimitiveIndex p = 0; p < input_.reach.size(); ++p) {
      if (input_.reach[p].intersects(box)) near_chunk_.push_back(p);
    }
  }

  /// Assigns the points of the block to primitives.
  void segment(std::size_t block) {
    if (looks_at_bounds_) bounds_ = blocks_.bounds(block);
    for (const PrimitiveIndex p : near_chunk_) {
      if (input_.reach.empty() || input_.reach[p].intersects(bounds_)) evaluate(p, block);
    }
    const BlockMask in_block = first_points(blocks_.size(block));
    BlockMask assigned{};
    for (std::size_t slot = 0; slot < active_count_; ++slot) {
      BlockMask& member = active_[slot].contributions.member;
      member = both(member, in_block);
      assigned = either(assigned, member);
      const std::size_t members = point_count(member);
      share_.points_of_primitive[active_[slot].primitive] += members;
      active_[slot].has_members = members > 0;
    }
    share_.unassigned += blocks_.size(block) - point_count(assigned);
    segmented_count_ = active_count_;
  }

  /// Makes the primitive active, unless it is.
  void evaluate(PrimitiveIndex p, std::size_t block) {
    if (slot_of_[p] != k_none) return;
    slot_of_[p] = static_cast<std::uint32_t>(active_count_);
    if (active_count_ == active_.size()) active_.emplace_back();
    ActivePrimitive<Real>& active = active_[active_count_++];
    active.primitive = p;
    BlockField<Real>& field = active.field;
    evaluate_field(input_.primitives[p], blocks_.positions(block), spans_of(field));
    compute_contributions(field, blocks_.normals(block), input_.parameters[p], active.contributions);
  }

  [[nodiscard]] const ActivePrimitive<Real>& active(PrimitiveIndex p) const { return active_[slot_of_[p]]; }

  void choose_roots() {
    for (const std::uint32_t k : wanted_) is_wanted_[k] = false;
    wanted_ = input_.roots_of_all_points;
    for (const std::uint32_t k : wanted_) is_wanted_[k] = true;
    for (std::size_t slot = 0; slot < segmented_count_; ++slot) {
      if (!active_[slot].has_members) continue;
      for (const std::uint32_t k : input_.roots_of[active_[slot].primitive]) {
        if (is_wanted_[k] || (input_.roots[k].region && !input_.roots[k].region->intersects(bounds_))) continue;
        wanted_.push_back(k);
        is_wanted_[k] = true;
      }
    }
  }

  void forget_block() {
    for (std::size_t slot = 0; slot < active_count_; ++slot) slot_of_[active_[slot].primitive] = k_none;
    active_count_ = 0;
  }

  /// Owners that are not active have no points here.
  [[nodiscard]] BlockMask points_of(const Root& root, std::size_t block, std::size_t begin) const {
    BlockMask chosen = every_kth(begin, blocks_.size(block), root.stride);
    if (root.region && !holds_block(*root.region)) keep_to(*root.region, block, chosen);
    if (root.without_strangers) leave_out_strangers(root, chosen);
    if (root.all_points) return chosen;
    BlockMask any{};
    for (const PrimitiveIndex p : root.owners) {
      if (slot_of_[p] >= segmented_count_) continue;
      any = either(any, active(p).contributions.member);
    }
    return both(chosen, any);
  }

  /// A side of a region, rounded like the points, so that all uses see it at one place.
  static Eigen::Array<Real, 3, 1> rounded(const Eigen::Vector3d& corner) { return corner.cast<Real>().array(); }

  [[nodiscard]] bool holds_block(const AlignedBox& region) const {
    return (rounded(bounds_.min()) >= rounded(region.min())).all() &&
           (rounded(bounds_.max()) < rounded(region.max())).all();
  }

  /// Removes the points outside of the region, as RankClassesRequest::region says.
  void keep_to(const AlignedBox& region, std::size_t block, BlockMask& chosen) const {
    const BasicPointsView<Real> points = blocks_.positions(block);
    const Eigen::Array<Real, 3, 1> least = rounded(region.min());
    const Eigen::Array<Real, 3, 1> most = rounded(region.max());
    for (std::size_t i = 0; i < k_block_points; ++i) {
      const Eigen::Array<Real, 3, 1> point(points.x[i], points.y[i], points.z[i]);
      if ((point < least || point >= most).any()) remove_point(chosen, i);
    }
  }

  /// Removes the points inside a primitive that is not of the root. None are inside one that is not active.
  void leave_out_strangers(const Root& root, BlockMask& chosen) const {
    for (std::size_t slot = 0; slot < segmented_count_; ++slot) {
      const ActivePrimitive<Real>& other = active_[slot];
      if (std::ranges::binary_search(root.primitives, other.primitive)) continue;
      chosen = without(chosen, other.contributions.inside);
    }
  }

  [[nodiscard]] std::span<const std::uint16_t> places_of(const BlockMask& mask) {
    std::size_t found = 0;
    for (std::size_t w = 0; w < mask.size(); ++w) {
      for (std::uint64_t word = mask[w]; word != 0; word &= word - 1) {
        places_[found++] = static_cast<std::uint16_t>(w * 64 + static_cast<std::size_t>(std::countr_zero(word)));
      }
    }
    return std::span(places_).first(found);
  }

  /// `begin` is the number of points before the block.
  void group(std::size_t k, std::size_t block, std::size_t begin) {
    const Root& root = input_.roots[k];
    const std::span<const std::uint16_t> chosen = places_of(points_of(root, block, begin));
    if (chosen.empty()) return;
    make_keys(root);
    ClassTable& table = share_.tables[k];
    groups_.group(keys_, chosen);
    const std::span<std::uint32_t> classes = std::span(classes_).first(groups_.size());
    table.find_or_insert(keys_, groups_.first_points(), classes);
    pack_loud_pairs(root);
    add_up(chosen);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const std::span<PackedContribution> sums = table.add_points(classes[g], groups_.count(g));
      for (std::size_t pair = 0; pair < loud_.size(); ++pair) {
        const std::array<PackedContribution, 2>& added = sums_[g * loud_.size() + pair];
        sums[loud_[pair]] += added[0];
        sums[loud_[pair] + 1] += added[1];
      }
    }
  }

  /// Sums the contributions of each group's points.
  void add_up(std::span<const std::uint16_t> chosen) {
    if (loud_.empty()) return;
    sums_.assign(groups_.size() * loud_.size(), {});
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      std::array<PackedContribution, 2>* const sums = &sums_[groups_.group_of(i) * loud_.size()];
      for (std::size_t pair = 0; pair < loud_.size(); ++pair) {
        const std::array<PackedContribution, 2>& added = pairs_[pair].of[chosen[i]];
        sums[pair][0] += added[0];
        sums[pair][1] += added[1];
      }
    }
  }

  /// Packs the contributions of the root's primitives in pairs. Skips pairs that contribute nothing in the block.
  void pack_loud_pairs(const Root& root) {
    static constexpr BlockContributions<Real> k_nothing{};
    loud_.clear();
    for (std::size_t place = 0; place < root.primitives.size(); place += 2) {
      const BlockContributions<Real>& first = active(root.primitives[place]).contributions;
      const BlockContributions<Real>& second =
          place + 1 < root.primitives.size() ? active(root.primitives[place + 1]).contributions : k_nothing;
      if (first.is_silent && second.is_silent) continue;
      if (loud_.size() == pairs_.size()) pairs_.emplace_back();
      interleave(first.units, second.units, pairs_[loud_.size()]);
      loud_.push_back(place);
    }
  }

  void make_keys(const Root& root) {
    keys_.reshape(root.key_words());
    const KeyLayout layout = root.layout();
    if (root.primitives.size() <= RankClasses::k_byte_limit) {
      columns_.clear();
      for (const PrimitiveIndex p : root.primitives) {
        columns_.push_back(
            {active(p).field.distance.data(), active(p).contributions.smallest, active(p).contributions.largest});
      }
      const std::span<RankColumn> ranks = std::span(ranks_).first(root.primitives.size());
      compute_signed_ranks(columns_, ranks);
      pack_rank_keys(ranks, layout, keys_);
    } else {
      std::vector<const Real*> distances;
      for (const PrimitiveIndex p : root.primitives) distances.push_back(active(p).field.distance.data());
      sort_rank_keys(distances, layout, keys_);
    }
    if (root.has_member_word) {
      members_.clear();
      for (const PrimitiveIndex p : root.primitives) members_.push_back(&active(p).contributions.member);
      pack_member_word(members_, keys_);
    }
    compute_hashes(keys_);
  }

  BlockKeys keys_;
  const WorkerInput<Real>& input_;
  PointBlocks<Real> blocks_;
  std::vector<PrimitiveIndex> near_chunk_;     // primitives that points of the chunk may belong to
  std::vector<ActivePrimitive<Real>> active_;  // the first active_count_ are in use
  std::size_t active_count_ = 0;
  std::size_t segmented_count_ = 0;     // active ones that may have points here; the others have none
  std::vector<std::uint32_t> slot_of_;  // by primitive: its place among the active ones, or k_none
  std::vector<std::uint32_t> wanted_;   // roots that take points of the block
  std::vector<bool> is_wanted_;         // by root
  bool looks_at_bounds_;
  AlignedBox bounds_;  // bounds of the block, if they are looked at
  std::vector<DistanceColumn<Real>> columns_;
  std::vector<RankColumn> ranks_;
  std::vector<const BlockMask*> members_;
  std::vector<std::size_t> loud_;   // see pack_loud_pairs
  std::vector<PackedPairs> pairs_;  // the first loud_.size() are in use
  BlockGroups groups_;
  std::vector<std::array<PackedContribution, 2>> sums_;  // by group and loud pair
  std::array<std::uint16_t, k_block_points> places_{};
  std::array<std::uint32_t, k_block_points> classes_{};
  WorkerShare share_;
};

}  // namespace

void WorkerShare::absorb_counts(const WorkerShare& other) {
  for (std::size_t p = 0; p < points_of_primitive.size(); ++p) points_of_primitive[p] += other.points_of_primitive[p];
  unassigned += other.unassigned;
  segment_seconds += other.segment_seconds;
  classes_seconds += other.classes_seconds;
}

template <class Real>
WorkerShare work_on_chunks(const WorkerInput<Real>& input, std::size_t first, std::size_t last, const RunContext& run) {
  Worker<Real> worker(input);
  for (std::size_t chunk = first; chunk < last; ++chunk) {
    run.throw_if_stopped();
    // The first share stands for all: they have one size and advance together.
    if (first == 0) run.report("classes", chunk, last);
    worker.process(chunk);
  }
  return std::move(worker.share());
}

template WorkerShare work_on_chunks(const WorkerInput<double>&, std::size_t, std::size_t, const RunContext&);
template WorkerShare work_on_chunks(const WorkerInput<float>&, std::size_t, std::size_t, const RunContext&);

}  // namespace cloud2csg
