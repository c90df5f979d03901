#pragma once

#include <stdexcept>

#include "io/step/opencascade/bodies.hpp"

namespace cloud2csg::brep {

class BooleanFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One way to retry a failed operation.
struct BooleanSettings {
  double fuzzy = 0;         ///< distance up to which faces coincide; 0: the kernel's tolerance
  bool one_by_one = false;  ///< operands one at a time instead of together
};

// Each operand is a group of bodies. A body whose box meets no other is returned unchanged.
// @throws BooleanFailure, Standard_Failure, Cancelled
[[nodiscard]] Bodies unite(const std::vector<Bodies>& operands, const BooleanSettings& settings, const RunContext& run);
[[nodiscard]] Bodies intersect(const std::vector<Bodies>& operands, const BooleanSettings& settings,
                               const RunContext& run);
[[nodiscard]] Bodies subtract(const Bodies& from, const std::vector<Bodies>& removed, const BooleanSettings& settings,
                              const RunContext& run);

}  // namespace cloud2csg::brep
