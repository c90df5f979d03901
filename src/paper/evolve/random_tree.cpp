#include "paper/evolve/random_tree.hpp"

namespace cloud2csg {

CsgTree random_tree(std::size_t count, int height, RandomStream& random) {
  if (height <= 0 || random.chance(0.5)) return CsgTree::leaf(random.below(count));
  const std::uint32_t operation = random.below(4);
  const CsgTree first = random_tree(count, height - 1, random);
  if (operation == 3) return complement(first);
  const CsgTree second = random_tree(count, height - 1, random);
  return operation == 0 ? unite(first, second) : operation == 1 ? intersect(first, second) : subtract(first, second);
}

}  // namespace cloud2csg
