#pragma once

#include "cloud2csg/model.hpp"

namespace cloud2csg::test {

/// A tree over a solid of each type, turned and moved, with complements of complements.
inline Model model_of_every_type() {
  return parse_model(R"({"format": "cloud2csg", "version": 1, "primitives": [
    {"id": "box", "type": "box", "pose": {"position": [1, 2, 3], "quaternion": [0.5, 0.5, 0.5, 0.5]}, "size": [2, 3, 4]},
    {"id": "cone", "type": "cone", "pose": {"position": [3, 2, 3], "quaternion": [0.6, 0, 0.8, 0]},
     "radius_bottom": 1, "radius_top": 0.2, "height": 4},
    {"id": "torus", "type": "torus", "pose": {"position": [1, 5, 3], "quaternion": [0.6, 0.48, 0.64, 0]},
     "major_radius": 1.5, "minor_radius": 0.5},
    {"id": "horn torus", "type": "torus", "pose": {"position": [-2.7, 2, 3]}, "major_radius": 1, "minor_radius": 1},
    {"id": "sphere", "type": "sphere", "pose": {"position": [1, 2, 6]}, "radius": 1.7},
    {"id": "cut", "type": "half_space", "pose": {"position": [1, 2, 3], "quaternion": [0.8, 0, 0.36, 0.48]}},
    {"id": "keep", "type": "half_space", "pose": {"position": [1, 2, 6.6]}},
    {"id": "polytope", "type": "polytope", "pose": {"position": [1, -1, 3], "quaternion": [0.6, 0.48, 0.64, 0]},
     "planes": [[-1, 0, 0, 1], [0, -1, 0, 1], [0, 0, -1, 1], [0.6, 0.8, 0, 1], [0, 0, 1, 1], [0, 0.6, 0.8, 1.1]]},
    {"id": "key", "type": "extrusion", "pose": {"position": [4, -1, 3], "quaternion": [0.6, 0.48, 0.64, 0]},
     "profile": [[[-1, -0.5], [1, -0.5, 1], [1, 0.5], [-1, 0.5, 0.3]], [[0.8, 0, 1], [1.2, 0, 1]]], "height": 1},
    {"id": "bell", "type": "revolution", "pose": {"position": [-2, -1, 3], "quaternion": [0.6, 0.48, 0.64, 0]},
     "profile": [[[0, 0], [1, 0], [0.7, 0.6, 0.2], [0, 1.2]]]},
    {"id": "egg", "type": "expression", "pose": {"position": [1, 2, 0.2], "quaternion": [0.6, 0.48, 0.64, 0]},
     "distance": "sqrt(x^2 + y^2 + 0.5 * z^2) - 1", "bounds": [[-1.1, -1.1, -1.5], [1.1, 1.1, 1.5]]}],
    "tree": {"op": "difference", "children": [
      {"op": "intersection", "children": [
        {"op": "union", "children": [{"primitive": "box"}, {"primitive": "cone"}, {"primitive": "torus"},
          {"primitive": "horn torus"}, {"primitive": "sphere"}, {"primitive": "polytope"}, {"primitive": "key"},
          {"primitive": "bell"}, {"primitive": "egg"}]},
        {"op": "complement", "children": [{"op": "complement", "children": [{"primitive": "keep"}]}]}]},
      {"op": "complement", "children": [{"op": "union", "children": [{"primitive": "cut"}, {"primitive": "sphere"}]}]}]}})");
}

}  // namespace cloud2csg::test
