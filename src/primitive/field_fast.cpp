#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "primitive/field_fast.cpp"
#include <hwy/foreach_target.h>  // includes this file once per instruction set

#include <array>
#include <cstddef>
#include <span>

#include "cloud2csg/primitive.hpp"
#include "primitive/formulas-inl.hpp"
#include "primitive/placement.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

using FastTag = hn::ScalableTag<double>;
using FastLanes = hn::Vec<FastTag>;

HWY_INLINE Vector<FastLanes> load_point(FastTag tag, PointsView points, std::size_t i) {
  return {hn::LoadU(tag, &points.x[i]), hn::LoadU(tag, &points.y[i]), hn::LoadU(tag, &points.z[i])};
}

HWY_INLINE Field<FastLanes> load_field(FastTag tag, const FieldSpans& fields, std::size_t i) {
  return {hn::LoadU(tag, &fields.distance[i]),
          {hn::LoadU(tag, &fields.gradient_x[i]), hn::LoadU(tag, &fields.gradient_y[i]),
           hn::LoadU(tag, &fields.gradient_z[i])}};
}

HWY_INLINE void store_field(FastTag tag, const Field<FastLanes>& field, const FieldSpans& out, std::size_t i) {
  hn::StoreU(field.distance, tag, &out.distance[i]);
  hn::StoreU(field.gradient.x, tag, &out.gradient_x[i]);
  hn::StoreU(field.gradient.y, tag, &out.gradient_y[i]);
  hn::StoreU(field.gradient.z, tag, &out.gradient_z[i]);
}

/// A partial vector of points and fields, filled up with zeros.
class Padded {
 public:
  Padded(PointsView points, const FieldSpans& fields, std::size_t offset) : count_(points.size() - offset) {
    const std::array<std::span<const double>, k_rows> sources = {
        points.x, points.y, points.z, fields.distance, fields.gradient_x, fields.gradient_y, fields.gradient_z};
    for (std::size_t row = 0; row < k_rows; ++row) {
      for (std::size_t i = 0; i < count_; ++i) rows_[row][i] = sources[row][offset + i];
    }
  }

  [[nodiscard]] PointsView points() const { return {rows_[0], rows_[1], rows_[2]}; }
  [[nodiscard]] FieldSpans fields() {
    return {.distance = rows_[3], .gradient_x = rows_[4], .gradient_y = rows_[5], .gradient_z = rows_[6]};
  }
  void copy_fields_to(const FieldSpans& out, std::size_t offset) const {
    const std::array<std::span<double>, 4> targets = {out.distance, out.gradient_x, out.gradient_y, out.gradient_z};
    for (std::size_t row = 0; row < targets.size(); ++row) {
      for (std::size_t i = 0; i < count_; ++i) targets[row][offset + i] = rows_[3 + row][i];
    }
  }

 private:
  static constexpr std::size_t k_rows = 7;
  static constexpr std::size_t k_most_lanes = HWY_MAX_BYTES / sizeof(double);

  std::size_t count_;
  std::array<std::array<double, k_most_lanes>, k_rows> rows_ = {};
};

/// Applies `kernel` to whole vectors of points, the last and partial one by way of a padded copy.
template <class Kernel>
HWY_INLINE void for_each_vector(FastTag tag, PointsView points, const FieldSpans& out, const Kernel& kernel) {
  const std::size_t lanes = hn::Lanes(tag);
  std::size_t i = 0;
  for (; i + lanes <= points.size(); i += lanes) kernel.apply(tag, points, out, i);
  if (i == points.size()) return;
  Padded padded(points, out, i);
  kernel.apply(tag, padded.points(), padded.fields(), 0);
  padded.copy_fields_to(out, i);
}

template <class Formula>
struct EvaluateKernel {
  Formula formula;

  HWY_INLINE void apply(FastTag tag, PointsView points, const FieldSpans& out, std::size_t i) const {
    store_field(tag, formula.at(load_point(tag, points, i)), out, i);
  }
};

struct DisplaceKernel {
  DisplacementFormula<FastTag> formula;

  HWY_INLINE void apply(FastTag tag, PointsView points, const FieldSpans& out, std::size_t i) const {
    store_field(tag, formula.added_to(load_field(tag, out, i), load_point(tag, points, i)), out, i);
  }
};

struct FieldLoop {
  PointsView points;
  FieldSpans out;

  template <class Formula>
  void run(FastTag tag, const Formula& formula) const {
    for_each_vector(tag, points, out, EvaluateKernel<Formula>{formula});
  }
};

void evaluate_shape(const Primitive& primitive, const Placement& placement, PointsView points, const FieldSpans& out) {
  run_formula(FastTag(), primitive, placement, FieldLoop{points, out});
}

void displace(double frequency, const Placement& placement, PointsView points, const FieldSpans& out) {
  const FastTag tag;
  for_each_vector(tag, points, out, DisplaceKernel{DisplacementFormula<FastTag>(tag, frequency, placement)});
}

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cassert>
#include <variant>

#include "primitive/expression_field.hpp"

namespace cloud2csg {

HWY_EXPORT(evaluate_shape);
HWY_EXPORT(displace);

void evaluate_field(const Primitive& primitive, PointsView points, const FieldSpans& out) {
  assert(out.distance.size() == points.size() && out.gradient_x.size() == points.size() &&
         out.gradient_y.size() == points.size() && out.gradient_z.size() == points.size());
  const Placement placement = placement_of(primitive.pose);
  if (std::holds_alternative<Expression>(primitive.shape)) {
    evaluate_expression(primitive, points, out);
  } else {
    HWY_DYNAMIC_DISPATCH(evaluate_shape)(primitive, placement, points, out);
  }
  if (primitive.displacement) {
    HWY_DYNAMIC_DISPATCH(displace)(primitive.displacement->frequency, placement, points, out);
  }
}

}  // namespace cloud2csg
#endif
