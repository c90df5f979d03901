#include "cells/side_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cells/side_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/fields/mask_bits-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// As many lanes as fit two bytes of bits.
template <class Real>
using Lanes = hn::CappedTag<Real, 16>;

template <class Real>
void sides_of_block(const BlockField<Real>& field, const BlockNormals<Real>& normals,
                    const SegmentationTolerances& tolerances, BlockSides& out) {
  const Lanes<Real> d;
  const auto all = [d](double value) { return hn::Set(d, static_cast<Real>(value)); };
  const auto farthest = all(tolerances.distance);
  const auto open = all(tolerances.distance * k_open_share);
  const auto least_square = all(tolerances.cosine * tolerances.cosine);
  const auto zero = hn::Zero(d);
  for (std::size_t w = 0; w < out.near.size(); ++w) {
    BlockSides word;
    for (std::size_t k = 0; k < 64; k += hn::Lanes(d)) {
      const std::size_t i = 64 * w + k;
      const auto f = hn::Load(d, &field.distance[i]);
      const auto gx = hn::Load(d, &field.gradient_x[i]);
      const auto gy = hn::Load(d, &field.gradient_y[i]);
      const auto gz = hn::Load(d, &field.gradient_z[i]);
      const auto dot =
          gx * hn::Load(d, normals.x + i) + gy * hn::Load(d, normals.y + i) + gz * hn::Load(d, normals.z + i);
      const auto is_near = hn::Abs(f) <= farthest;
      // Where the gradient is zero there is no surface.
      const auto square = gx * gx + gy * gy + gz * gz;
      const auto agrees = hn::And(dot * dot >= least_square * square, square > zero);
      const auto is_on = hn::And(is_near, agrees);
      word.inside[0] |= bits_of(d, f < zero) << k;
      word.near[0] |= bits_of(d, is_near) << k;
      word.open[0] |= bits_of(d, hn::Abs(f) <= open) << k;
      word.along[0] |= bits_of(d, hn::And(is_on, dot > zero)) << k;
      word.against[0] |= bits_of(d, hn::And(is_on, dot < zero)) << k;
    }
    out.inside[w] = word.inside[0];
    out.near[w] = word.near[0];
    out.open[w] = word.open[0];
    out.along[w] = word.along[0];
    out.against[w] = word.against[0];
  }
}

void sides_in_double(const BlockField<double>& field, const BlockNormals<double>& normals,
                     const SegmentationTolerances& tolerances, BlockSides& out) {
  sides_of_block(field, normals, tolerances, out);
}
void sides_in_single(const BlockField<float>& field, const BlockNormals<float>& normals,
                     const SegmentationTolerances& tolerances, BlockSides& out) {
  sides_of_block(field, normals, tolerances, out);
}

}  // namespace
}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cloud2csg {

HWY_EXPORT(sides_in_double);
HWY_EXPORT(sides_in_single);

void compute_sides(const BlockField<double>& field, const BlockNormals<double>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out) {
  HWY_DYNAMIC_DISPATCH(sides_in_double)(field, normals, tolerances, out);
}
void compute_sides(const BlockField<float>& field, const BlockNormals<float>& normals,
                   const SegmentationTolerances& tolerances, BlockSides& out) {
  HWY_DYNAMIC_DISPATCH(sides_in_single)(field, normals, tolerances, out);
}

}  // namespace cloud2csg
#endif  // HWY_ONCE
