#pragma once

#include "cloud2csg/rank_classes.hpp"
#include "fitness/class_table.hpp"

namespace cloud2csg {

/// Turns grouped points into the table that trees are evaluated on.
class RankClassesBuilder {
 public:
  [[nodiscard]] static RankClasses build(std::span<const PrimitiveIndex> primitives, const ClassTable& classes,
                                         const KeyLayout& layout, const Objective& objective);

 private:
  template <class Rank>
  static void fill(RankClasses& result, AlignedVector<Rank>& ranks, const ClassTable& classes, const KeyLayout& layout);
};

}  // namespace cloud2csg
