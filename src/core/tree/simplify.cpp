#include "cloud2csg/csg_tree.hpp"
#include "core/tree/conjunction.hpp"
#include "core/tree/factor.hpp"
#include "core/tree/propagate.hpp"

namespace cloud2csg {

CsgTree simplify(const CsgTree& tree) {
  Formula formula = to_formula(tree);
  FormulaIndex index;
  Propagation propagation;
  Factoring factoring;
  do {
    do index.build(formula);
    while (propagation.run(formula, index));
  } while (factoring.run(formula, index));
  return to_tree(formula);
}

}  // namespace cloud2csg
