#include "raw/solids/outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// A border edge, turned so that the faces of the set are on its left.
struct BorderEdge {
  ProfileSegment segment;
  std::uint32_t start, end, curve;
};

std::vector<BorderEdge> border_of(const Drawing& drawing, const FaceSet& faces) {
  std::vector<BorderEdge> border;
  for (std::size_t e = 0; e < drawing.arrangement.edges.size(); ++e) {
    const CurveArrangement::Edge& edge = drawing.arrangement.edges[e];
    if (faces[edge.left] == faces[edge.right]) continue;
    const ProfileSegment& s = edge.segment;
    if (faces[edge.left] != 0) {
      border.push_back({s, edge.start, edge.end, drawing.curve_of_edge[e]});
    } else {
      border.push_back({segment_between(s.end, -s.bulge, s.start), edge.end, edge.start, drawing.curve_of_edge[e]});
    }
  }
  return border;
}

/// By how much a path turns left from one edge to the next, in (-pi, pi].
double turn_between(const BorderEdge& from, const BorderEdge& to) {
  const Vector2d before = to_the_left(from.segment.normal(1));
  const Vector2d after = to_the_left(to.segment.normal(0));
  return std::atan2(cross(before, after), before.dot(after));
}

/// The edges in closed loops. Where several leave a vertex, the sharpest left turn keeps to the same faces.
std::vector<std::vector<BorderEdge>> loops_of(const std::vector<BorderEdge>& border, std::size_t vertices) {
  std::vector<std::vector<std::size_t>> leaving(vertices);
  for (std::size_t k = 0; k < border.size(); ++k) leaving[border[k].start].push_back(k);
  std::vector<std::vector<BorderEdge>> loops;
  for (std::size_t first = 0; first < border.size(); ++first) {
    if (std::ranges::find(leaving[border[first].start], first) == leaving[border[first].start].end()) continue;
    std::vector<BorderEdge>& loop = loops.emplace_back();
    std::size_t edge = first;
    while (true) {
      std::erase(leaving[border[edge].start], edge);
      loop.push_back(border[edge]);
      if (border[edge].end == border[first].start) break;
      const std::vector<std::size_t>& next = leaving[border[edge].end];
      edge = *std::ranges::max_element(next, {}, [&](std::size_t k) { return turn_between(border[edge], border[k]); });
    }
  }
  return loops;
}

/// The circle of the longest edge. Edges are turned a little to meet at crossings, a long one the least.
ClosedPath circle_of(const std::vector<BorderEdge>& loop) {
  const auto length = [](const BorderEdge& edge) { return edge.segment.length(); };
  const ProfileSegment& arc = std::ranges::max_element(loop, {}, length)->segment;
  const Vector2d arm(arc.radius, 0);
  const double bulge = std::copysign(1.0, arc.bulge);
  return {{.point = arc.centre - arm, .bulge = bulge}, {.point = arc.centre + arm, .bulge = bulge}};
}

/// Joins edges of one curve.
ClosedPath path_of(std::vector<BorderEdge> loop) {
  const auto changes = [&](std::size_t k) { return loop[k].curve != loop[(k + loop.size() - 1) % loop.size()].curve; };
  std::size_t first = 0;
  while (first < loop.size() && !changes(first)) ++first;
  if (first == loop.size()) return circle_of(loop);
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(first), loop.end());
  ClosedPath path;
  double angle = 0;
  const auto finish = [&] {
    const double bulge = std::tan(angle / 4);
    const bool is_half = std::abs(std::abs(bulge) - 1) < 1e-9;  // up to rounding
    if (!path.empty()) path.back().bulge = is_half ? std::copysign(1.0, bulge) : bulge;
    angle = 0;
  };
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (k == 0 || loop[k].curve != loop[k - 1].curve) {
      finish();
      path.push_back({.point = loop[k].segment.start});
    }
    angle += loop[k].segment.angle;
  }
  finish();
  return path;
}

}  // namespace

Profile outline_of(const Drawing& drawing, const FaceSet& faces) {
  Profile profile;
  for (std::vector<BorderEdge>& loop : loops_of(border_of(drawing, faces), drawing.arrangement.vertices.size())) {
    profile.paths.push_back(path_of(std::move(loop)));
  }
  return profile;
}

bool is_valid(const Profile& profile, bool is_turned) {
  try {
    if (is_turned) {
      validate_turned_profile(profile);
    } else {
      validate_profile(profile);
    }
    return true;
  } catch (const Error&) {
    return false;
  }
}

bool is_writable(const Drawing& drawing, const FaceSet& faces) {
  return is_valid(outline_of(drawing, faces), drawing.is_turned);
}

}  // namespace cloud2csg
