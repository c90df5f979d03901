#include "fitness/point_worker.hpp"

#include <algorithm>
#include <bit>

#include "base/stopwatch.hpp"

namespace cloud2csg {
namespace {

BlockMask first_bits(std::size_t count) {
  BlockMask mask{};
  for (std::size_t w = 0; w < mask.size(); ++w) {
    const std::size_t bits = count > 64 * w ? std::min<std::size_t>(count - 64 * w, 64) : 0;
    mask[w] = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }
  return mask;
}

/// Of the points begin .. begin + count - 1, those whose place is a multiple of the stride.
BlockMask every_kth(std::size_t begin, std::size_t count, std::size_t stride) {
  if (stride == 1) return first_bits(count);
  BlockMask mask{};
  for (std::size_t i = (stride - begin % stride) % stride; i < count; i += stride) {
    mask[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  return mask;
}

std::size_t count_bits(const BlockMask& mask) {
  std::size_t count = 0;
  for (const std::uint64_t word : mask) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

template <class Real>
class Worker {
 public:
  explicit Worker(const WorkerInput<Real>& input)
      : input_(input),
        blocks_(input.cloud, input.box),
        fields_(input.primitives.size()),
        contributions_(input.primitives.size()) {
    share_.points_of_primitive.resize(input.primitives.size());
    std::size_t most_primitives = 0;
    for (const Root& root : input.roots) {
      share_.tables.emplace_back(root.primitives.size(), root.key_words());
      keys_.emplace_back(root.key_words());
      most_primitives = std::max(most_primitives, root.primitives.size());
    }
    ranks_.resize(most_primitives);
  }

  void process(std::size_t chunk) {
    Stopwatch watch;
    blocks_.load(chunk);
    for (std::size_t block = 0; block < blocks_.count(); ++block) {
      evaluate_fields(block);
      share_.segment_seconds += watch.lap();
      const std::size_t begin = chunk * k_chunk_points + block * k_block_points;
      for (std::size_t k = 0; k < input_.roots.size(); ++k) group(k, block, begin);
      share_.classes_seconds += watch.lap();
    }
  }

  [[nodiscard]] WorkerShare& share() { return share_; }

 private:
  void evaluate_fields(std::size_t block) {
    const BlockMask in_block = first_bits(blocks_.size(block));
    BlockMask assigned{};
    for (std::size_t p = 0; p < input_.primitives.size(); ++p) {
      BlockField<Real>& field = fields_[p];
      evaluate_field(input_.primitives[p], blocks_.positions(block),
                     BasicFieldSpans<Real>{.distance = field.distance,
                                           .gradient_x = field.gradient_x,
                                           .gradient_y = field.gradient_y,
                                           .gradient_z = field.gradient_z});
      compute_contributions(field, blocks_.normals(block), input_.parameters[p], contributions_[p]);
      BlockMask& member = contributions_[p].member;
      for (std::size_t w = 0; w < member.size(); ++w) {
        member[w] &= in_block[w];
        assigned[w] |= member[w];
      }
      share_.points_of_primitive[p] += count_bits(member);
    }
    share_.unassigned += blocks_.size(block) - count_bits(assigned);
  }

  [[nodiscard]] BlockMask points_of(const Root& root, std::size_t block, std::size_t begin) const {
    BlockMask chosen = every_kth(begin, blocks_.size(block), root.stride);
    if (root.all_points) return chosen;
    for (std::size_t w = 0; w < chosen.size(); ++w) {
      std::uint64_t any = 0;
      for (const PrimitiveIndex p : root.primitives) any |= contributions_[p].member[w];
      chosen[w] &= any;
    }
    return chosen;
  }

  /// The places of the bits that are set.
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
    make_keys(root, keys_[k]);
    ClassTable& table = share_.tables[k];
    const std::span<std::uint32_t> classes = std::span(classes_).first(chosen.size());
    table.find_or_insert(keys_[k], chosen, classes);
    loud_.clear();
    for (std::size_t place = 0; place < root.primitives.size(); ++place) {
      const BlockContributions<Real>& contributions = contributions_[root.primitives[place]];
      if (!contributions.is_silent) loud_.push_back({contributions.pairs.data(), 2 * place});
    }
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      table.add_points(classes[i], 1);
      add_contributions(chosen[i], table.sums(classes[i]));
    }
  }

  void make_keys(const Root& root, BlockKeys& keys) {
    const KeyLayout layout = root.layout();
    if (root.primitives.size() <= RankClasses::k_byte_limit) {
      columns_.clear();
      for (const PrimitiveIndex p : root.primitives) {
        columns_.push_back({fields_[p].distance.data(), contributions_[p].smallest, contributions_[p].largest});
      }
      const std::span<RankColumn> ranks = std::span(ranks_).first(root.primitives.size());
      compute_signed_ranks(columns_, ranks);
      pack_rank_keys(ranks, layout, keys);
    } else {
      std::vector<const Real*> distances;
      for (const PrimitiveIndex p : root.primitives) distances.push_back(fields_[p].distance.data());
      sort_rank_keys(distances, layout, keys);
    }
    if (root.has_member_word) {
      members_.clear();
      for (const PrimitiveIndex p : root.primitives) members_.push_back(&contributions_[p].member);
      pack_member_word(members_, keys);
    }
    compute_hashes(keys);
  }

  void add_contributions(std::size_t point, std::span<double> sums) const {
    for (const Loud& loud : loud_) {
      sums[loud.at] += static_cast<double>(loud.pairs[2 * point]);
      sums[loud.at + 1] += static_cast<double>(loud.pairs[2 * point + 1]);
    }
  }

  /// A primitive that contributes something in the block, and where its sums are in a class's.
  struct Loud {
    const float* pairs;
    std::size_t at;
  };

  const WorkerInput<Real>& input_;
  PointBlocks<Real> blocks_;
  std::vector<BlockField<Real>> fields_;
  std::vector<BlockContributions<Real>> contributions_;
  std::vector<DistanceColumn<Real>> columns_;
  std::vector<RankColumn> ranks_;
  std::vector<const BlockMask*> members_;
  std::vector<Loud> loud_;
  std::array<std::uint16_t, k_block_points> places_{};
  std::array<std::uint32_t, k_block_points> classes_{};
  std::vector<BlockKeys> keys_;  // by root
  WorkerShare share_;
};

}  // namespace

void WorkerShare::absorb(const WorkerShare& other) {
  for (std::size_t k = 0; k < tables.size(); ++k) tables[k].absorb(other.tables[k]);
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
    // The first share speaks for all: they are of one size and advance together.
    if (first == 0) run.report("classes", chunk, last);
    worker.process(chunk);
  }
  return std::move(worker.share());
}

template WorkerShare work_on_chunks(const WorkerInput<double>&, std::size_t, std::size_t, const RunContext&);
template WorkerShare work_on_chunks(const WorkerInput<float>&, std::size_t, std::size_t, const RunContext&);

}  // namespace cloud2csg
