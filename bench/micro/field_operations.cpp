#include "micro/field_operations.hpp"

#include <cassert>

#include "core/primitive/formulas-inl.hpp"

namespace cloud2csg::bench {
namespace {

namespace formulas = cloud2csg::HWY_NAMESPACE;

struct OnePoint {
  template <class Formula>
  void run(CountingTag tag, const Formula& formula) const {
    const Counted any{tag.count};
    formula.at({any, any, any});
  }
};

}  // namespace

OperationCount field_operations(const Primitive& primitive) {
  assert(is_plain(primitive));
  OperationCount count;
  formulas::run_formula(CountingTag{&count}, primitive, placement_of(primitive.pose), OnePoint{});
  return count;
}

}  // namespace cloud2csg::bench
