#pragma once

#include "cloud2csg/advanced/rank_classes.hpp"
#include "paper/objective/class_table.hpp"

namespace cloud2csg {

/// Turns grouped points into the table that trees are evaluated on.
class RankClassesBuilder {
 public:
  /// KeyLayout(primitives.size()) packs the keys of the classes.
  [[nodiscard]] static RankClasses build(std::span<const PrimitiveIndex> primitives, const ClassTable& classes,
                                         const Objective& objective);

 private:
  template <class Rank>
  static void fill(RankClasses& result, AlignedVector<Rank>& ranks, const ClassTable& classes);
};

}  // namespace cloud2csg
