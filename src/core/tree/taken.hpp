#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// The points where a tree takes the value of one primitive, and the sign of each value: 1 or -1.
struct Taken {
  std::vector<std::size_t> points;
  std::vector<double> signs;
};

/// By primitive, the points of each ascending. Ties are broken as by implicit_gradient().
[[nodiscard]] std::vector<Taken> taken_by_primitive(const CsgTree& tree, const PrimitiveSet& primitives,
                                                    PointsView points);

}  // namespace cloud2csg
