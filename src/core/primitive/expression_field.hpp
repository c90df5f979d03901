#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// The fields of an Expression, without displacement, a point at a time. Spans have the size of `points`; an empty
/// gradient is not computed. Shared by the plain and the fast path: a formula that is only known as text has no
/// vectors. Precondition: the shape is an Expression. @throws Error when the formula does not parse.
void evaluate_expression(const Primitive& primitive, PointsView points, const FieldSpans& out);

}  // namespace cloud2csg
