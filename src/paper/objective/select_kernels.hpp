#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cloud2csg/advanced/rank_classes.hpp"

/// The vectorised evaluation of a tree on signed ranks.
namespace cloud2csg {

/// Columns of signed ranks and the scores they look up; see RankClasses for the layout.
template <class Rank>
struct RankTable {
  const Rank* ranks;    ///< by primitive, then by class
  const float* scores;  ///< by class, then by signed rank + primitives
  std::size_t primitives;
  std::size_t padded;  ///< classes, rounded up to a multiple of k_class_padding; the rest has rank and score 0
};
inline constexpr std::size_t k_class_padding = 64;

/// The sum of the selected scores over all classes.
[[nodiscard]] double tree_geometry(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes,
                                   RankScratch& scratch);
[[nodiscard]] double tree_geometry(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes,
                                   RankScratch& scratch);

/// The score that the tree selects in each class, one entry of `scores` a class.
void tree_class_scores(const RankTable<std::int8_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                       std::span<float> scores);
void tree_class_scores(const RankTable<std::int16_t>& table, std::span<const CsgNode> nodes, RankScratch& scratch,
                       std::span<float> scores);

/// Sums of the scores that a column of ranks and its negation look up.
[[nodiscard]] RankClasses::ColumnGeometry column_geometry(const RankTable<std::int8_t>& table,
                                                          std::span<const std::int8_t> column);

/// The plain reference: one class at a time.
template <class Rank>
[[nodiscard]] int select_rank(const RankTable<Rank>& table, std::span<const CsgNode> nodes, std::size_t class_index);

/// out = min(a, b), max(a, b) or max(a, -b), by the operation.
void combine_columns(Operation operation, std::span<const std::int8_t> a, std::span<const std::int8_t> b,
                     std::span<std::int8_t> out);

}  // namespace cloud2csg
