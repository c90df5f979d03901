#pragma once

#include <cmath>
#include <numbers>

#include "cloud2csg/error.hpp"
#include "cloud2csg/primitive.hpp"
#include "core/primitive/profile.hpp"

/// Random profiles. `draw(low, high)` gives a number in this range.
namespace cloud2csg::test {

inline bool is_valid(const Profile& profile) {
  try {
    validate_profile(profile);
    return true;
  } catch (const Error&) {
    return false;
  }
}

inline ClosedPath circle_path(const Eigen::Vector2d& centre, double radius) {
  const Eigen::Vector2d arm(radius, 0);
  return {{.point = centre - arm, .bulge = 1}, {.point = centre + arm, .bulge = 1}};
}

/// What a circle turned around an axis that it crosses encloses: an apple, or a lemon if the circle's centre is beyond.
inline Revolution turned_arc(double centre, double radius) {
  const double half_angle = std::acos(-centre / radius);
  const double end = radius * std::sin(half_angle);
  return {{{{{.point = {0, -end}, .bulge = std::tan(half_angle / 2)}, {.point = {0, end}}}}}};
}

/// A regular polygon around the origin.
inline ClosedPath regular_path(std::size_t corners, double radius) {
  ClosedPath path;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    path.push_back({.point = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle))});
  }
  return path;
}

/// A star of lines and arcs around the origin, 0.5 to 1 far from it, in either direction; with a round hole if there is
/// room.
template <class Draw>
Profile any_profile(const Draw& draw) {
  const auto corners = static_cast<std::size_t>(draw(3.0, 8.0));
  const double direction = draw(-1.0, 1.0) < 0 ? -1 : 1;
  ClosedPath path;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle =
        direction * 2 * std::numbers::pi * (static_cast<double>(i) + draw(0.0, 0.4)) / static_cast<double>(corners);
    const double bulge = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(-0.3, 1.2);
    path.push_back({.point = draw(0.5, 1.0) * Eigen::Vector2d(std::cos(angle), std::sin(angle)), .bulge = bulge});
  }
  const Profile with_hole{.paths = {path, circle_path({draw(-0.1, 0.1), draw(-0.1, 0.1)}, draw(0.05, 0.2))}};
  if (draw(0.0, 1.0) < 0.5 && is_valid(with_hole)) return with_hole;
  Profile profile{.paths = {path}};
  if (is_valid(profile)) return profile;
  for (PathCorner& corner : profile.paths[0]) corner.bulge = 0;  // a star of lines never crosses itself
  return profile;
}

/// A ring, or a solid around the axis with a flat or pointed bottom.
template <class Draw>
Revolution any_full_turn(const Draw& draw) {
  if (draw(0.0, 1.0) < 0.5) {
    Profile ring = any_profile(draw);
    const double far = draw(0.1, 1.0) - bounds_of(ring).min().x();
    for (ClosedPath& path : ring.paths) {
      for (PathCorner& corner : path) corner.point.x() += far;
    }
    return {ring};
  }
  const double low = draw(-1.0, -0.2);
  ClosedPath path{{.point = {0, low}},
                  {.point = {draw(0.3, 1.0), low + (draw(0.0, 1.0) < 0.5 ? 0.0 : draw(-0.3, 0.3))}, .bulge = 0},
                  {.point = {draw(0.3, 1.0), draw(0.0, 0.5)}, .bulge = draw(0.0, 1.0) < 0.5 ? 0.0 : draw(0.1, 0.4)},
                  {.point = {0, draw(0.6, 1.0)}}};
  return {{.paths = {path}}};
}

/// A full turn or a sector.
template <class Draw>
Revolution any_revolution(const Draw& draw) {
  Revolution revolution = any_full_turn(draw);
  if (draw(0.0, 1.0) < 0.5) revolution.angle_deg = draw(5.0, 355.0);
  return revolution;
}

}  // namespace cloud2csg::test
