#pragma once

#include <pybind11/pybind11.h>

#include "cloud2csg/csg_tree.hpp"

/// Converts trees to and from the nested objects of cloud2csg/tree.py.
namespace cloud2csg::python {

/// O(size), no recursion.
[[nodiscard]] pybind11::object to_nodes(const CsgTree& tree, const PrimitiveSet& primitives);

/// From nested objects or the text form. O(size), no recursion.
/// @throws Error for a leaf that is not a primitive's id; TypeError for anything else
[[nodiscard]] CsgTree to_tree(const pybind11::object& tree, const PrimitiveSet& primitives);

}  // namespace cloud2csg::python
