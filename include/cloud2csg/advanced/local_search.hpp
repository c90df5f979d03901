#pragma once

#include <cstddef>

#include "cloud2csg/advanced/option_table.hpp"

namespace cloud2csg {

/// Options of searches that climb by the best small change of a tree.
struct LocalSearchOptions {
  bool shrink_only = false;
  std::size_t evaluation_limit = 100'000;
  double work_limit = 4e10;
};
void option_table(OptionsOf<LocalSearchOptions>, auto&& field) {
  using O = LocalSearchOptions;
  field(&O::shrink_only, "shrink_only", "Allow only changes that make the tree smaller (redundancy removal)");
  field(&O::evaluation_limit, "evaluation_limit", "Largest number of trees to evaluate");
  field(&O::work_limit, "work_limit",
        "Largest number of evaluations x classes x nodes. The default takes about ten seconds, however large the table "
        "is. On cells: evaluations x (cells + patches + nodes x cells / 64).",
        at_least(0));
}

}  // namespace cloud2csg
