#pragma once

#include "core/fields/bounded_field.hpp"

namespace cloud2csg {

/// A solid made fit for a grid: finite, and every value either a known Lipschitz function or known to be outside.
struct BoundedSolid {
  CsgTree tree = {};
  PrimitiveSet primitives = {};
  AlignedBox bounds;  ///< finite, encloses the solid; empty for an empty solid
};

/// The solid cut at `bounds`. Expressions are cut at their own bounds, beyond which their formula means nothing.
/// @throws Error when neither the solid nor `bounds` is finite.
[[nodiscard]] BoundedSolid bound_solid(const Model& model, const AlignedBox& bounds);

}  // namespace cloud2csg
