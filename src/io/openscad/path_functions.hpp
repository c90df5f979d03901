#pragma once

#include <string_view>

namespace cloud2csg::scad {

/// The functions that turn a path with arcs into corners. Our .scad files end with them, and the reader knows them by
/// their words: it evaluates no other functions.
inline constexpr std::string_view k_path_functions = R"(
// The corners of a closed path. Where an arc starts, a corner is [x, y, bulge]: the bulge is tan(angle / 4) of the arc,
// positive if it turns left.
function path(corners) = [
  for (i = [0 : len(corners) - 1]) each segment(corners[i], corners[(i + 1) % len(corners)], corners[i][2])];
function segment(a, b, bulge) = is_undef(bulge) ? [[a.x, a.y]] :
  let (angle = 4 * atan(bulge), steps = max(2, round($fn * abs(angle) / 360)),
       centre = [a.x + b.x, a.y + b.y] / 2 + (1 - bulge * bulge) / (4 * bulge) * [a.y - b.y, b.x - a.x],
       arm = [a.x, a.y] - centre)
  [for (k = [0 : steps - 1]) let (t = angle * k / steps)
    centre + [arm.x * cos(t) - arm.y * sin(t), arm.x * sin(t) + arm.y * cos(t)]];
)";

}  // namespace cloud2csg::scad
