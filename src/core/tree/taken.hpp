#pragma once

#include <cstddef>
#include <vector>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// The points at which a tree takes the value of one primitive, and with which sign: 1 or -1.
struct Taken {
  std::vector<std::size_t> points;
  std::vector<double> signs;
};

/// By primitive; the points of each ascending. Of several with the same value, one is chosen as by implicit_gradient().
[[nodiscard]] std::vector<Taken> taken_by_primitive(const CsgTree& tree, const PrimitiveSet& primitives,
                                                    PointsView points);

}  // namespace cloud2csg
