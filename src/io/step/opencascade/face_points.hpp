#pragma once

#include <TopoDS_Face.hxx>
#include <vector>

#include "cloud2csg/geometry.hpp"

namespace cloud2csg::brep {

/// A few points of a face, away from its edges; none when it is too thin to have any.
[[nodiscard]] std::vector<Eigen::Vector3d> points_on_face(const TopoDS_Face& face);

}  // namespace cloud2csg::brep
