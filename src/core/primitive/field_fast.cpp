#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/primitive/field_fast.cpp"
#include <hwy/foreach_target.h>  // includes this file once per instruction set

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "cloud2csg/primitive.hpp"
#include "core/primitive/formulas-inl.hpp"
#include "core/primitive/placement.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

template <class Real>
using FastTag = hn::ScalableTag<Real>;
template <class Real>
using FastLanes = hn::Vec<FastTag<Real>>;

template <class Real>
HWY_INLINE Vector<FastLanes<Real>> load_point(BasicPointsView<Real> points, std::size_t i) {
  const FastTag<Real> tag;
  return {hn::LoadU(tag, &points.x[i]), hn::LoadU(tag, &points.y[i]), hn::LoadU(tag, &points.z[i])};
}

template <class Real>
HWY_INLINE Field<FastLanes<Real>> load_field(const BasicFieldSpans<Real>& fields, std::size_t i) {
  const FastTag<Real> tag;
  return {hn::LoadU(tag, &fields.distance[i]),
          {hn::LoadU(tag, &fields.gradient_x[i]), hn::LoadU(tag, &fields.gradient_y[i]),
           hn::LoadU(tag, &fields.gradient_z[i])}};
}

template <class Real>
HWY_INLINE void store_field(const Field<FastLanes<Real>>& field, const BasicFieldSpans<Real>& out, std::size_t i) {
  const FastTag<Real> tag;
  hn::StoreU(field.distance, tag, &out.distance[i]);
  hn::StoreU(field.gradient.x, tag, &out.gradient_x[i]);
  hn::StoreU(field.gradient.y, tag, &out.gradient_y[i]);
  hn::StoreU(field.gradient.z, tag, &out.gradient_z[i]);
}

/// A partial vector of points and fields, padded with zeros.
template <class Real>
class Padded {
 public:
  Padded(BasicPointsView<Real> points, const BasicFieldSpans<Real>& fields, std::size_t offset)
      : count_(points.size() - offset) {
    const std::array<std::span<const Real>, k_rows> sources = {
        points.x, points.y, points.z, fields.distance, fields.gradient_x, fields.gradient_y, fields.gradient_z};
    for (std::size_t row = 0; row < k_rows; ++row) {
      for (std::size_t i = 0; i < count_; ++i) rows_[row][i] = sources[row][offset + i];
    }
  }

  [[nodiscard]] BasicPointsView<Real> points() const { return {rows_[0], rows_[1], rows_[2]}; }
  [[nodiscard]] BasicFieldSpans<Real> fields() {
    return {.distance = rows_[3], .gradient_x = rows_[4], .gradient_y = rows_[5], .gradient_z = rows_[6]};
  }
  void copy_fields_to(const BasicFieldSpans<Real>& out, std::size_t offset) const {
    const std::array<std::span<Real>, 4> targets = {out.distance, out.gradient_x, out.gradient_y, out.gradient_z};
    for (std::size_t row = 0; row < targets.size(); ++row) {
      for (std::size_t i = 0; i < count_; ++i) targets[row][offset + i] = rows_[3 + row][i];
    }
  }

 private:
  static constexpr std::size_t k_rows = 7;
  static constexpr std::size_t k_most_lanes = HWY_MAX_BYTES / sizeof(Real);

  std::size_t count_;
  std::array<std::array<Real, k_most_lanes>, k_rows> rows_ = {};
};

/// Applies `kernel` to whole vectors of points. The last, partial one goes through a padded copy.
template <class Real, class Kernel>
HWY_INLINE void for_each_vector(BasicPointsView<Real> points, const BasicFieldSpans<Real>& out, const Kernel& kernel) {
  const std::size_t lanes = hn::Lanes(FastTag<Real>());
  std::size_t i = 0;
  for (; i + lanes <= points.size(); i += lanes) kernel.apply(points, out, i);
  if (i == points.size()) return;
  Padded<Real> padded(points, out, i);
  kernel.apply(padded.points(), padded.fields(), 0);
  padded.copy_fields_to(out, i);
}

template <class Formula>
struct EvaluateKernel {
  Formula formula;

  template <class Real>
  HWY_INLINE void apply(BasicPointsView<Real> points, const BasicFieldSpans<Real>& out, std::size_t i) const {
    store_field(formula.at(load_point(points, i)), out, i);
  }
};

struct DisplaceKernel {
  DisplacementFormula<FastTag<double>> formula;

  HWY_INLINE void apply(PointsView points, const FieldSpans& out, std::size_t i) const {
    store_field(formula.added_to(load_field(out, i), load_point(points, i)), out, i);
  }
};

template <class Real>
struct FieldLoop {
  BasicPointsView<Real> points;
  BasicFieldSpans<Real> out;

  template <class Formula>
  void run(FastTag<Real> /*tag*/, const Formula& formula) const {
    for_each_vector(points, out, EvaluateKernel<Formula>{formula});
  }
};

struct DistanceLoop {
  PointsView points;
  std::span<double> distance;

  template <class Formula>
  void run(FastTag<double> tag, const Formula& formula) const {
    const std::size_t lanes = hn::Lanes(tag);
    const std::size_t whole = points.size() / lanes * lanes;
    for (std::size_t i = 0; i < whole; i += lanes) {
      hn::StoreU(formula.at(load_point(points, i)).distance, tag, &distance[i]);
    }
    if (whole == points.size()) return;
    std::array<std::array<double, HWY_MAX_BYTES / sizeof(double)>, 3> rest{};
    for (std::size_t i = whole; i < points.size(); ++i) {
      rest[0][i - whole] = points.x[i], rest[1][i - whole] = points.y[i], rest[2][i - whole] = points.z[i];
    }
    std::array<double, HWY_MAX_BYTES / sizeof(double)> values{};
    hn::StoreU(formula.at(load_point(PointsView{rest[0], rest[1], rest[2]}, 0)).distance, tag, values.data());
    std::copy_n(values.begin(), points.size() - whole, distance.begin() + static_cast<std::ptrdiff_t>(whole));
  }
};

void distance_of_shape(const Primitive& primitive, const Placement& placement, PointsView points,
                       std::span<double> distance) {
  run_formula(FastTag<double>(), primitive, placement, DistanceLoop{points, distance});
}

void evaluate_shape(const Primitive& primitive, const Placement& placement, PointsView points, const FieldSpans& out) {
  run_formula(FastTag<double>(), primitive, placement, FieldLoop<double>{points, out});
}

void evaluate_shape_in_single(const Primitive& primitive, const Placement& placement, BasicPointsView<float> points,
                              const BasicFieldSpans<float>& out) {
  run_formula(FastTag<float>(), primitive, placement, FieldLoop<float>{points, out});
}

void displace(double frequency, const Placement& placement, PointsView points, const FieldSpans& out) {
  for_each_vector(points, out,
                  DisplaceKernel{DisplacementFormula<FastTag<double>>(FastTag<double>(), frequency, placement)});
}

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cassert>
#include <variant>
#include <vector>

#include "core/primitive/expression.hpp"

namespace cloud2csg {

HWY_EXPORT(distance_of_shape);
HWY_EXPORT(evaluate_shape);
HWY_EXPORT(evaluate_shape_in_single);
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

void evaluate_distance(const Primitive& primitive, PointsView points, std::span<double> out) {
  assert(out.size() == points.size());
  if (primitive.displacement) {
    Points slope(points.size());
    evaluate_field(primitive, points,
                   {.distance = out, .gradient_x = slope.x, .gradient_y = slope.y, .gradient_z = slope.z});
  } else if (std::holds_alternative<Expression>(primitive.shape)) {
    evaluate_expression(primitive, points, {.distance = out, .gradient_x = {}, .gradient_y = {}, .gradient_z = {}});
  } else {
    HWY_DYNAMIC_DISPATCH(distance_of_shape)(primitive, placement_of(primitive.pose), points, out);
  }
}

namespace {

/// For primitives that have no formula in single precision.
void evaluate_in_double(const Primitive& primitive, BasicPointsView<float> points, const BasicFieldSpans<float>& out) {
  Points wide;
  wide.x.assign(points.x.begin(), points.x.end());
  wide.y.assign(points.y.begin(), points.y.end());
  wide.z.assign(points.z.begin(), points.z.end());
  std::vector<double> distance(points.size());
  Points slope(points.size());
  evaluate_field(primitive, wide,
                 {.distance = distance, .gradient_x = slope.x, .gradient_y = slope.y, .gradient_z = slope.z});
  const auto narrow = [](const std::vector<double>& from, std::span<float> to) {
    std::transform(from.begin(), from.end(), to.begin(), [](double value) { return static_cast<float>(value); });
  };
  narrow(distance, out.distance);
  narrow(slope.x, out.gradient_x);
  narrow(slope.y, out.gradient_y);
  narrow(slope.z, out.gradient_z);
}

}  // namespace

void evaluate_field(const Primitive& primitive, BasicPointsView<float> points, const BasicFieldSpans<float>& out) {
  assert(out.distance.size() == points.size() && out.gradient_x.size() == points.size() &&
         out.gradient_y.size() == points.size() && out.gradient_z.size() == points.size());
  if (is_plain(primitive)) {
    HWY_DYNAMIC_DISPATCH(evaluate_shape_in_single)(primitive, placement_of(primitive.pose), points, out);
  } else {
    evaluate_in_double(primitive, points, out);
  }
}

}  // namespace cloud2csg
#endif
