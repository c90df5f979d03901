#pragma once

#include "cloud2csg/primitive.hpp"
#include "micro/counted.hpp"

namespace cloud2csg::bench {

/// Operations for signed distance and gradient of a primitive at one point. Precondition: is_plain().
[[nodiscard]] OperationCount field_operations(const Primitive& primitive);

}  // namespace cloud2csg::bench
