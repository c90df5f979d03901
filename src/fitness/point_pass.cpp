#include <algorithm>
#include <bit>
#include <cassert>
#include <chrono>

#include "base/parallel.hpp"
#include "fitness/class_table.hpp"
#include "fitness/point_kernels.hpp"
#include "fitness/rank_classes_builder.hpp"

namespace cloud2csg {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Whether the gradient has length one wherever it is defined: all but what a user's formula or a displacement bends.
bool has_unit_gradient(const Primitive& primitive) {
  return !primitive.displacement && !std::holds_alternative<Expression>(primitive.shape);
}

/// What every worker reads.
struct PassInput {
  const PointCloud& cloud;
  const PrimitiveSet& primitives;
  std::span<const RankClassesRequest> requests;
  std::vector<ContributionParameters> parameters;  // by primitive
  std::vector<KeyLayout> layouts;                  // by request
};

/// What a worker gathers from its share of the points; shares are added up at the end.
struct Share {
  std::vector<ClassTable> tables;
  std::vector<std::size_t> points_of_primitive;
  std::size_t unassigned = 0;
  double segment_seconds = 0;
  double classes_seconds = 0;

  void absorb(const Share& other) {
    for (std::size_t k = 0; k < tables.size(); ++k) tables[k].absorb(other.tables[k]);
    for (std::size_t p = 0; p < points_of_primitive.size(); ++p) points_of_primitive[p] += other.points_of_primitive[p];
    unassigned += other.unassigned;
    segment_seconds += other.segment_seconds;
    classes_seconds += other.classes_seconds;
  }
};

BlockMask first_bits(std::size_t count) {
  BlockMask mask{};
  for (std::size_t w = 0; w < mask.size(); ++w) {
    const std::size_t bits = count > 64 * w ? std::min<std::size_t>(count - 64 * w, 64) : 0;
    mask[w] = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  }
  return mask;
}

/// Of the points begin .. begin + count - 1, those whose index is a multiple of the stride.
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

/// One worker: takes blocks of points through distances, membership, contributions, ranks and classes.
class Worker {
 public:
  explicit Worker(const PassInput& input)
      : input_(input), fields_(input.primitives.size()), contributions_(input.primitives.size()) {
    share_.points_of_primitive.resize(input.primitives.size());
    std::size_t most_words = 0;
    for (std::size_t k = 0; k < input.requests.size(); ++k) {
      share_.tables.emplace_back(input.requests[k].primitives.size(), input.layouts[k]);
      most_words = std::max(most_words, input.layouts[k].words);
    }
    keys_.resize(most_words * k_block_points);
  }

  void process(std::size_t begin, std::size_t count) {
    const Clock::time_point start = Clock::now();
    evaluate_fields(begin, count);
    const double segmenting = seconds_since(start);
    for (std::size_t k = 0; k < input_.requests.size(); ++k) group(k, begin, count);
    share_.segment_seconds += segmenting;
    share_.classes_seconds += seconds_since(start) - segmenting;
  }

  [[nodiscard]] Share& share() { return share_; }

 private:
  void evaluate_fields(std::size_t begin, std::size_t count) {
    const PointsView positions = input_.cloud.positions.view().subview(begin, count);
    const PointsView normals = input_.cloud.normals.view().subview(begin, count);
    std::ranges::copy(normals.x, normals_.x.begin());
    std::ranges::copy(normals.y, normals_.y.begin());
    std::ranges::copy(normals.z, normals_.z.begin());
    const BlockMask in_block = first_bits(count);
    BlockMask assigned{};
    for (std::size_t p = 0; p < input_.primitives.size(); ++p) {
      BlockField& field = fields_[p];
      evaluate_field(input_.primitives[p], positions,
                     {.distance = std::span(field.distance).first(count),
                      .gradient_x = std::span(field.gradient_x).first(count),
                      .gradient_y = std::span(field.gradient_y).first(count),
                      .gradient_z = std::span(field.gradient_z).first(count)});
      compute_contributions(field, normals_, input_.parameters[p], contributions_[p]);
      BlockMask& member = contributions_[p].member;
      for (std::size_t w = 0; w < member.size(); ++w) {
        member[w] &= in_block[w];
        assigned[w] |= member[w];
      }
      share_.points_of_primitive[p] += count_bits(member);
    }
    share_.unassigned += count - count_bits(assigned);
  }

  [[nodiscard]] BlockMask points_of(const RankClassesRequest& request, std::size_t begin, std::size_t count) const {
    BlockMask chosen = every_kth(begin, count, request.stride);
    if (request.all_points) return chosen;
    for (std::size_t w = 0; w < chosen.size(); ++w) {
      std::uint64_t any = 0;
      for (const PrimitiveIndex p : request.primitives) any |= contributions_[p].member[w];
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

  void group(std::size_t k, std::size_t begin, std::size_t count) {
    const RankClassesRequest& request = input_.requests[k];
    const std::span<const std::uint16_t> chosen = places_of(points_of(request, begin, count));
    if (chosen.empty()) return;
    columns_.clear();
    for (const PrimitiveIndex p : request.primitives) columns_.push_back(fields_[p].distance.data());
    if (request.primitives.size() <= RankClasses::k_byte_limit) {
      compute_rank_keys(columns_, input_.layouts[k], keys_.data());
    } else {
      sort_rank_keys(columns_, input_.layouts[k], keys_.data());
    }
    ClassTable& table = share_.tables[k];
    table.count_points(chosen.size());
    const std::span<std::uint32_t> classes = std::span(classes_).first(chosen.size());
    table.find_or_insert(keys_.data(), chosen, classes);
    pairs_.clear();
    for (const PrimitiveIndex p : request.primitives) pairs_.push_back(contributions_[p].pairs.data());
    for (std::size_t i = 0; i < chosen.size(); ++i) add_contributions(chosen[i], table.sums(classes[i]));
  }

  void add_contributions(std::size_t point, std::span<double> sums) const {
    double* sum = sums.data();
    for (const float* pairs : pairs_) {
      sum[0] += static_cast<double>(pairs[2 * point]);
      sum[1] += static_cast<double>(pairs[2 * point + 1]);
      sum += 2;
    }
  }

  const PassInput& input_;
  BlockNormals normals_;
  std::vector<BlockField> fields_;
  std::vector<BlockContributions> contributions_;
  std::vector<const double*> columns_;
  std::vector<const float*> pairs_;
  std::array<std::uint16_t, k_block_points> places_{};
  std::array<std::uint32_t, k_block_points> classes_{};
  std::vector<std::uint64_t, boost::alignment::aligned_allocator<std::uint64_t, 64>> keys_;
  Share share_;
};

constexpr std::size_t k_blocks_between_checks = 64;

Share process_range(const PassInput& input, std::size_t first_block, std::size_t last_block, const RunContext& run) {
  Worker worker(input);
  for (std::size_t block = first_block; block < last_block; ++block) {
    if ((block - first_block) % k_blocks_between_checks == 0) {
      run.throw_if_stopped();
      // The first share speaks for all: they are of one size and advance together.
      if (first_block == 0) run.report("classes", block, last_block);
    }
    const std::size_t begin = block * k_block_points;
    worker.process(begin, std::min(k_block_points, input.cloud.size() - begin));
  }
  return std::move(worker.share());
}

/// As many shares as threads: each costs a set of tables. The result does not depend on how many.
Share process_all(const PassInput& input, const RunContext& run) {
  const std::size_t blocks = (input.cloud.size() + k_block_points - 1) / k_block_points;
  const int threads = run.threads > 0 ? run.threads : usable_threads(run);
  const std::size_t parts = std::clamp<std::size_t>(blocks, 1, static_cast<std::size_t>(threads));
  if (parts == 1) return process_range(input, 0, blocks, run);
  std::vector<Share> shares(parts);
  for_each_index(parts, run, [&](std::size_t k) {
    shares[k] = process_range(input, blocks * k / parts, blocks * (k + 1) / parts, run);
  });
  for (std::size_t k = 1; k < parts; ++k) shares.front().absorb(shares[k]);
  return std::move(shares.front());
}

}  // namespace

PointPass build_rank_classes(const PointCloud& cloud, const PrimitiveSet& primitives,
                             std::span<const RankClassesRequest> requests, const SegmentationTolerances& tolerances,
                             const ObjectiveOptions& objective, double noise, const RunContext& run) {
  assert(cloud.has_normals());
  const Objective scale = resolve(objective, cloud.size(), noise);
  PassInput input{cloud, primitives, requests, {}, {}};
  for (const Primitive& primitive : primitives) {
    input.parameters.push_back({scale.beta, scale.gamma, tolerances, has_unit_gradient(primitive)});
  }
  for (const RankClassesRequest& request : requests) {
    assert(!request.primitives.empty() && request.stride > 0);
    input.layouts.emplace_back(request.primitives.size());
  }
  Share share = process_all(input, run);
  PointPass pass;
  pass.points_of_primitive = std::move(share.points_of_primitive);
  pass.unassigned = share.unassigned;
  pass.segment_seconds = share.segment_seconds;
  const Clock::time_point start = Clock::now();
  for (std::size_t k = 0; k < requests.size(); ++k) {
    const ClassTable& classes = share.tables[k];
    pass.tables.push_back(RankClassesBuilder::build(requests[k].primitives, classes, input.layouts[k],
                                                    resolve(objective, classes.point_count(), noise)));
  }
  pass.classes_seconds = share.classes_seconds + seconds_since(start);
  return pass;
}

}  // namespace cloud2csg
