#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg::bench {

/// Measures intersection over union of trees and a true one, by counting places in both and in either. The places lie
/// on a jittered lattice in the joint bounds of the primitives, outside of which no bounded tree over them has
/// anything. Which primitives a place is in is found once, so that a tree costs microseconds.
///
/// Standard error of an IoU q: below sqrt(q (1 - q) / places in either): 2e-4 at 0.995 for 150 000 of these.
class Judge {
 public:
  static constexpr std::size_t k_places = 200'000;

  /// `primitives`: all that any tree to be judged is over; bounded. `truth` is not empty. O(places x primitives)
  Judge(const PrimitiveSet& primitives, const CsgTree& truth, std::size_t places = k_places);

  /// 0 for an unbounded tree and for an empty one. O(places x size / 64)
  [[nodiscard]] double intersection_over_union(const CsgTree& tree) const;

 private:
  using Bits = std::vector<std::uint64_t>;  ///< one a place

  [[nodiscard]] Bits inside(const CsgTree& tree) const;
  [[nodiscard]] Bits leaf(const CsgNode& node) const;

  std::size_t words_ = 0;
  std::vector<Bits> inside_primitive_;
  Bits inside_truth_;
};

}  // namespace cloud2csg::bench
