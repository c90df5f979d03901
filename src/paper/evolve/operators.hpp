#pragma once

#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"

/// The genetic operators: crossover and mutation of the paper, on flat trees.
namespace cloud2csg {

struct Children {
  CsgTree first, second;
};

/// Two children that swapped one random subtree each. A child that would be higher than the limit stays as its own
/// parent was.
[[nodiscard]] Children crossover(const CsgTree& a, const CsgTree& b, int height_limit, RandomStream& random);

/// A tree with one random subtree replaced by a new random tree that keeps the height limit.
[[nodiscard]] CsgTree mutate_subtree(const CsgTree& tree, std::size_t primitives, int height_limit,
                                     RandomStream& random);

}  // namespace cloud2csg
