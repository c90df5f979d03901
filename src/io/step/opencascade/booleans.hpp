#pragma once

#include <stdexcept>

#include "io/step/opencascade/bodies.hpp"

namespace cloud2csg::brep {

/// An operation that the kernel could not do.
class BooleanFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One way of doing an operation again after it failed.
struct BooleanSettings {
  double fuzzy = 0;         ///< how far apart faces may be that count as one; 0: the kernel's tolerance
  bool one_by_one = false;  ///< operands one after the other, not all at a time
};

// Of several groups of bodies each. Bodies whose boxes meet no other are passed on as they are.
// @throws BooleanFailure, Standard_Failure, Cancelled
[[nodiscard]] Bodies unite(const std::vector<Bodies>& operands, const BooleanSettings& settings, const RunContext& run);
[[nodiscard]] Bodies intersect(const std::vector<Bodies>& operands, const BooleanSettings& settings,
                               const RunContext& run);
[[nodiscard]] Bodies subtract(const Bodies& from, const std::vector<Bodies>& removed, const BooleanSettings& settings,
                              const RunContext& run);

}  // namespace cloud2csg::brep
