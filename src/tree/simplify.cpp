#include "cloud2csg/simplify.hpp"

#include "tree/conjunction.hpp"
#include "tree/factor.hpp"
#include "tree/propagate.hpp"

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
