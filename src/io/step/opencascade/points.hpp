#pragma once

#include <Eigen/Core>
#include <gp_Pnt.hxx>

namespace cloud2csg::brep {

[[nodiscard]] inline gp_Pnt point_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace cloud2csg::brep
