#include "paper/objective/select_kernels.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "paper/objective/select_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// Classes that go through the tree at once, so that the stack of columns stays in the first-level cache.
constexpr std::size_t k_chunk = 1024;

AlignedVector<std::int8_t>& stack_memory(RankScratch& scratch, std::int8_t /*tag*/) {
  return scratch.bytes;
}
AlignedVector<std::int16_t>& stack_memory(RankScratch& scratch, std::int16_t /*tag*/) {
  return scratch.words;
}

template <class Rank>
HWY_INLINE void combine(Operation operation, const Rank* a, const Rank* b, Rank* out, std::size_t count) {
  const hn::ScalableTag<Rank> d;
  const std::size_t lanes = hn::Lanes(d);
  switch (operation) {
    case Operation::union_of:
      for (std::size_t i = 0; i < count; i += lanes)
        hn::Store(hn::Min(hn::Load(d, a + i), hn::Load(d, b + i)), d, out + i);
      break;
    case Operation::intersection:
      for (std::size_t i = 0; i < count; i += lanes)
        hn::Store(hn::Max(hn::Load(d, a + i), hn::Load(d, b + i)), d, out + i);
      break;
    default:
      for (std::size_t i = 0; i < count; i += lanes) {
        hn::Store(hn::Max(hn::Load(d, a + i), hn::Neg(hn::Load(d, b + i))), d, out + i);
      }
      break;
  }
}

template <class Rank>
HWY_INLINE void negate(const Rank* a, Rank* out, std::size_t count) {
  const hn::ScalableTag<Rank> d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) hn::Store(hn::Neg(hn::Load(d, a + i)), d, out + i);
}

/// The tree's column for `count` classes from `begin`. Leaves stay in place; results go to stack slots.
template <class Rank>
HWY_INLINE const Rank* select_chunk(const RankTable<Rank>& table, std::span<const CsgNode> nodes, std::size_t begin,
                                    std::size_t count, Rank* stack, const void** operands) {
  std::size_t height = 0;
  for (const CsgNode& node : nodes) {
    if (node.operation() == Operation::primitive) {
      operands[height++] = table.ranks + node.primitive() * table.padded + begin;
    } else if (node.operation() == Operation::complement) {
      Rank* const out = stack + (height - 1) * k_chunk;
      negate(static_cast<const Rank*>(operands[height - 1]), out, count);
      operands[height - 1] = out;
    } else {
      --height;
      Rank* const out = stack + (height - 1) * k_chunk;
      combine(node.operation(), static_cast<const Rank*>(operands[height - 1]),
              static_cast<const Rank*>(operands[height]), out, count);
      operands[height - 1] = out;
    }
  }
  return static_cast<const Rank*>(operands[0]);
}

/// Sums the scores that `count` classes from `begin` look up. The sum is exact in double precision (see
/// compute_contributions), so the order of the lanes does not show.
template <class Rank>
HWY_INLINE double look_up(const RankTable<Rank>& table, const Rank* column, std::size_t begin, std::size_t count) {
  const hn::ScalableTag<double> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const hn::Rebind<Rank, decltype(d)> dr;
  const std::size_t lanes = hn::Lanes(d);
  const auto row = static_cast<std::int32_t>(2 * table.primitives + 1);
  const auto first = static_cast<std::int32_t>(begin) * row + static_cast<std::int32_t>(table.primitives);
  auto base = hn::Iota(di, 0) * hn::Set(di, row) + hn::Set(di, first);
  const auto step = hn::Set(di, static_cast<std::int32_t>(lanes) * row);
  auto sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto rank = hn::PromoteTo(di, hn::Load(dr, column + i));
    sum = sum + hn::PromoteTo(d, hn::GatherIndex(df, table.scores, base + rank));
    base = base + step;
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

/// Passes the tree's column to `use`, a chunk at a time.
template <class Rank, class Use>
HWY_INLINE void for_each_chunk(const RankTable<Rank>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                               const Use& use) {
  AlignedVector<Rank>& stack = stack_memory(scratch, Rank{});
  const std::size_t most_operands = nodes.size() / 2 + 1;
  if (stack.size() < most_operands * k_chunk) stack.resize(most_operands * k_chunk);
  if (scratch.operands.size() < most_operands) scratch.operands.resize(most_operands);
  for (std::size_t begin = 0; begin < table.padded; begin += k_chunk) {
    const std::size_t count = std::min(k_chunk, table.padded - begin);
    use(select_chunk(table, nodes, begin, count, stack.data(), scratch.operands.data()), begin, count);
  }
}

template <class Rank>
HWY_INLINE double geometry(const RankTable<Rank>& table, std::span<const CsgNode> nodes, RankScratch& scratch) {
  double sum = 0;
  for_each_chunk(table, nodes, scratch, [&](const Rank* column, std::size_t begin, std::size_t count) {
    sum += look_up(table, column, begin, count);
  });
  return sum;
}

template <class Rank>
HWY_INLINE void scores_by_class(const RankTable<Rank>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                                std::span<float> scores) {
  const std::size_t row = 2 * table.primitives + 1;
  for_each_chunk(table, nodes, scratch, [&](const Rank* column, std::size_t begin, std::size_t count) {
    const std::size_t end = std::min(begin + count, scores.size());
    for (std::size_t c = begin; c < end; ++c) {
      scores[c] = table.scores[c * row + table.primitives + static_cast<std::size_t>(column[c - begin])];
    }
  });
}

void scores_of_bytes(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                     std::span<float> scores) {
  scores_by_class(table, nodes, scratch, scores);
}

void scores_of_words(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                     std::span<float> scores) {
  scores_by_class(table, nodes, scratch, scores);
}

double geometry_of_bytes(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch) {
  return geometry(table, nodes, scratch);
}

double geometry_of_words(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch) {
  return geometry(table, nodes, scratch);
}

RankClasses::ColumnGeometry geometry_of_column(const RankTable<std::int8_t>& table,
                                               std::span<const std::int8_t> column) {
  RankClasses::ColumnGeometry sums{0, 0};
  alignas(64) std::array<std::int8_t, k_chunk> negated;  // NOLINT: each chunk is written before it is read
  for (std::size_t begin = 0; begin < table.padded; begin += k_chunk) {
    const std::size_t count = std::min(k_chunk, table.padded - begin);
    sums.of_column += look_up(table, column.data() + begin, begin, count);
    negate(column.data() + begin, negated.data(), count);
    sums.of_negation += look_up(table, static_cast<const std::int8_t*>(negated.data()), begin, count);
  }
  return sums;
}

void combine_bytes(Operation operation, std::span<const std::int8_t> a, std::span<const std::int8_t> b,
                   std::span<std::int8_t> out) {
  combine(operation, a.data(), b.data(), out.data(), a.size());
}

}  // namespace
}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cloud2csg {

HWY_EXPORT(geometry_of_bytes);
HWY_EXPORT(geometry_of_words);
HWY_EXPORT(scores_of_bytes);
HWY_EXPORT(scores_of_words);
HWY_EXPORT(geometry_of_column);
HWY_EXPORT(combine_bytes);

double tree_geometry(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch) {
  return HWY_DYNAMIC_DISPATCH(geometry_of_bytes)(table, nodes, scratch);
}

double tree_geometry(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch) {
  return HWY_DYNAMIC_DISPATCH(geometry_of_words)(table, nodes, scratch);
}

void tree_class_scores(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                       std::span<float> scores) {
  HWY_DYNAMIC_DISPATCH(scores_of_bytes)(table, nodes, scratch, scores);
}

void tree_class_scores(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                       std::span<float> scores) {
  HWY_DYNAMIC_DISPATCH(scores_of_words)(table, nodes, scratch, scores);
}

RankClasses::ColumnGeometry column_geometry(const RankTable<std::int8_t>& table, std::span<const std::int8_t> column) {
  return HWY_DYNAMIC_DISPATCH(geometry_of_column)(table, column);
}

void combine_columns(Operation operation, std::span<const std::int8_t> a, std::span<const std::int8_t> b,
                     std::span<std::int8_t> out) {
  assert(a.size() == b.size() && a.size() == out.size() && a.size() % k_class_padding == 0);
  HWY_DYNAMIC_DISPATCH(combine_bytes)(operation, a, b, out);
}

template <class Rank>
int select_rank(const RankTable<Rank>& table, std::span<const CsgNode> nodes, std::size_t class_index) {
  std::vector<int> stack;
  for (const CsgNode& node : nodes) {
    if (node.operation() == Operation::primitive) {
      stack.push_back(table.ranks[node.primitive() * table.padded + class_index]);
      continue;
    }
    const int second = stack.back();
    if (node.operation() == Operation::complement) {
      stack.back() = -second;
      continue;
    }
    stack.pop_back();
    const int first = stack.back();
    stack.back() = node.operation() == Operation::union_of       ? std::min(first, second)
                   : node.operation() == Operation::intersection ? std::max(first, second)
                                                                 : std::max(first, -second);
  }
  return stack.back();
}

template int select_rank(const RankTable<std::int8_t>&, std::span<const CsgNode>, std::size_t);
template int select_rank(const RankTable<std::int16_t>&, std::span<const CsgNode>, std::size_t);

}  // namespace cloud2csg
#endif  // HWY_ONCE
