#pragma once

#include "cloud2csg/primitive.hpp"

namespace cloud2csg::scad {

[[nodiscard]] bool has_arcs(const Profile& profile);

/// The profile with mapped corners. Precondition: if it has arcs, the map keeps circles round.
[[nodiscard]] Profile mapped(Profile profile, const Eigen::Matrix2d& linear, const Eigen::Vector2d& shift);

}  // namespace cloud2csg::scad
