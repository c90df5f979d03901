#include "raw/solids/arrangement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/disjoint_sets.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// A direction of an edge: 2 * edge, plus 1 from its end to its start.
using HalfEdge = std::uint32_t;

class Builder {
 public:
  Builder(std::span<const ProfileSegment> pieces, double tolerance)
      : pieces_(pieces), tolerance_(tolerance), splits_(pieces.size()) {}

  CurveArrangement build() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (is_place(i)) continue;
      for (const Vector2d& end : {pieces_[i].start, pieces_[i].end}) split(i, end);
      for (std::size_t j = 0; j < i; ++j) {
        if (!is_place(j)) split_each_other(i, j);
      }
    }
    for (std::size_t i = 0; i < pieces_.size(); ++i) add_edges(i);
    remove_dangling();
    sort_around_vertices();
    trace_loops();
    make_faces();
    return std::move(result_);
  }

 private:
  struct Split {
    double share;
    std::uint32_t vertex;
  };
  struct Loop {
    std::vector<HalfEdge> edges = {};
    double area = 0;
  };

  [[nodiscard]] bool is_place(std::size_t piece) const { return pieces_[piece].length() <= tolerance_; }

  std::uint32_t vertex_at(const Vector2d& place) {
    const auto found = std::ranges::find_if(
        result_.vertices, [&](const Vector2d& vertex) { return (vertex - place).norm() <= tolerance_; });
    if (found == result_.vertices.end()) {
      result_.vertices.push_back(place);
      return static_cast<std::uint32_t>(result_.vertices.size() - 1);
    }
    return static_cast<std::uint32_t>(found - result_.vertices.begin());
  }

  void split(std::size_t piece, const Vector2d& place) {
    splits_[piece].push_back({std::clamp(share_of(pieces_[piece], place), 0.0, 1.0), vertex_at(place)});
  }

  void split_each_other(std::size_t i, std::size_t j) {
    const ProfileSegment& a = pieces_[i];
    const ProfileSegment& b = pieces_[j];
    std::vector<Vector2d> places = crossings(a, b, tolerance_);
    for (const Vector2d& end : {a.start, a.end, b.start, b.end}) places.push_back(end);
    for (const Vector2d& place : places) {
      if ((nearest(a, place) - place).norm() > tolerance_ || (nearest(b, place) - place).norm() > tolerance_) continue;
      split(i, place);
      split(j, place);
    }
  }

  void add_edges(std::size_t piece) {
    std::vector<Split>& splits = splits_[piece];
    std::ranges::sort(splits, {}, &Split::share);
    for (std::size_t k = 1; k < splits.size(); ++k) {
      const auto [from, start] = splits[k - 1];
      const auto [to, end] = splits[k];
      if (start == end) continue;
      const double bulge = std::tan(pieces_[piece].angle * (to - from) / 4);
      CurveArrangement::Edge edge{.segment = segment_between(result_.vertices[start], bulge, result_.vertices[end]),
                                  .start = start,
                                  .end = end,
                                  .piece = static_cast<std::uint32_t>(piece),
                                  .left = 0,
                                  .right = 0};
      if (!is_known(edge)) result_.edges.push_back(std::move(edge));
    }
  }

  /// Whether another piece has the same edge.
  [[nodiscard]] bool is_known(const CurveArrangement::Edge& edge) const {
    const Vector2d middle = edge.segment.at(0.5);
    return std::ranges::any_of(result_.edges, [&](const CurveArrangement::Edge& other) {
      const bool has_same_ends =
          (other.start == edge.start && other.end == edge.end) || (other.start == edge.end && other.end == edge.start);
      return has_same_ends && (other.segment.at(0.5) - middle).norm() <= tolerance_;
    });
  }

  void remove_dangling() {
    std::vector<std::size_t> degree(result_.vertices.size(), 0);
    for (const CurveArrangement::Edge& edge : result_.edges) ++degree[edge.start], ++degree[edge.end];
    const auto is_dangling = [&](const CurveArrangement::Edge& edge) {
      if (degree[edge.start] > 1 && degree[edge.end] > 1) return false;
      --degree[edge.start], --degree[edge.end];
      return true;
    };
    while (std::erase_if(result_.edges, is_dangling) > 0) {
    }
  }

  [[nodiscard]] std::uint32_t origin_of(HalfEdge h) const {
    return h % 2 == 0 ? result_.edges[h / 2].start : result_.edges[h / 2].end;
  }

  /// Sorts by the place a little along each edge, because curves may be tangent to each other.
  void sort_around_vertices() {
    around_.resize(result_.vertices.size());
    const auto count = static_cast<HalfEdge>(2 * result_.edges.size());
    for (HalfEdge h = 0; h < count; ++h) around_[origin_of(h)].push_back(h);
    std::vector<double> angle(count);
    for (std::vector<HalfEdge>& edges : around_) {
      double reach = std::numeric_limits<double>::infinity();
      for (const HalfEdge h : edges) reach = std::min(reach, 0.5 * result_.edges[h / 2].segment.length());
      for (const HalfEdge h : edges) {
        const ProfileSegment& s = result_.edges[h / 2].segment;
        const double share = reach / s.length();
        const Vector2d arm = h % 2 == 0 ? Vector2d(s.at(share) - s.start) : Vector2d(s.at(1 - share) - s.end);
        angle[h] = std::atan2(arm.y(), arm.x());
      }
      std::ranges::sort(edges, {}, [&](HalfEdge h) { return angle[h]; });
    }
  }

  /// The next half-edge of the loop that has its face on the left.
  [[nodiscard]] HalfEdge next(HalfEdge h) const {
    const HalfEdge back = h ^ 1U;
    const std::vector<HalfEdge>& edges = around_[origin_of(back)];
    const auto place = std::ranges::find(edges, back);
    return place == edges.begin() ? edges.back() : *(place - 1);
  }

  void trace_loops() {
    constexpr std::size_t k_none = SIZE_MAX;
    loop_of_.assign(2 * result_.edges.size(), k_none);
    for (HalfEdge first = 0; first < loop_of_.size(); ++first) {
      if (loop_of_[first] != k_none) continue;
      Loop& loop = loops_.emplace_back();
      for (HalfEdge h = first; loop_of_[h] == k_none; h = next(h)) {
        loop_of_[h] = loops_.size() - 1;
        loop.edges.push_back(h);
      }
      loop.area = 0.5 * doubled_area(path_of(loop));
    }
  }

  [[nodiscard]] std::vector<ProfileSegment> path_of(const Loop& loop) const {
    std::vector<ProfileSegment> path;
    path.reserve(loop.edges.size());
    for (const HalfEdge h : loop.edges) {
      const ProfileSegment& s = result_.edges[h / 2].segment;
      path.push_back(h % 2 == 0 ? s : segment_between(s.end, -s.bulge, s.start));
    }
    return path;
  }

  /// The smallest face whose outline is around a loop that runs clockwise; the unbounded face if there is none.
  [[nodiscard]] std::uint32_t face_around(const Loop& hole, std::span<const std::uint32_t> face_of_loop) {
    const Vector2d place = result_.vertices[origin_of(hole.edges.front())];
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t face = 0;
    for (std::size_t l = 0; l < loops_.size(); ++l) {
      const Loop& loop = loops_[l];
      if (loop.area <= 0 || loop.area >= least || component_of(loop) == component_of(hole)) continue;
      if (!is_inside(path_of(loop), place)) continue;
      least = loop.area;
      face = face_of_loop[l];
    }
    return face;
  }

  /// A vertex that stands for all that are connected to the loop's.
  [[nodiscard]] std::size_t component_of(const Loop& loop) { return components_.root(origin_of(loop.edges.front())); }

  void make_faces() {
    components_ = DisjointSets(result_.vertices.size());
    for (const CurveArrangement::Edge& edge : result_.edges) components_.join(edge.start, edge.end);

    std::vector<std::uint32_t> face_of_loop(loops_.size(), 0);
    result_.areas = {0};
    for (std::size_t l = 0; l < loops_.size(); ++l) {
      if (loops_[l].area <= 0) continue;
      face_of_loop[l] = static_cast<std::uint32_t>(result_.areas.size());
      result_.areas.push_back(loops_[l].area);
    }
    for (std::size_t l = 0; l < loops_.size(); ++l) {
      if (loops_[l].area > 0) continue;
      face_of_loop[l] = face_around(loops_[l], face_of_loop);
      if (face_of_loop[l] > 0) result_.areas[face_of_loop[l]] += loops_[l].area;
    }
    for (std::size_t e = 0; e < result_.edges.size(); ++e) {
      result_.edges[e].left = face_of_loop[loop_of_[2 * e]];
      result_.edges[e].right = face_of_loop[loop_of_[2 * e + 1]];
    }
  }

  std::span<const ProfileSegment> pieces_;
  double tolerance_;
  std::vector<std::vector<Split>> splits_;
  std::vector<std::vector<HalfEdge>> around_ = {};  ///< by vertex, counterclockwise
  std::vector<std::size_t> loop_of_ = {};           ///< by half-edge
  std::vector<Loop> loops_ = {};
  DisjointSets components_ = DisjointSets(0);
  CurveArrangement result_ = {};
};

}  // namespace

double share_of(const ProfileSegment& s, const Vector2d& point) {
  if (!s.is_arc()) return (point - s.start).dot(s.end - s.start) / (s.end - s.start).squaredNorm();
  // Just before the start is the start.
  const double share = angle_from_start(s, point - s.centre) / s.angle;
  return share > 0.5 + std::numbers::pi / std::abs(s.angle) ? 0.0 : share;
}

CurveArrangement arrange(std::span<const ProfileSegment> pieces, double tolerance) {
  return Builder(pieces, tolerance).build();
}

FaceLocator::FaceLocator(const CurveArrangement& arrangement) {
  double high = -std::numeric_limits<double>::infinity();
  low_ = -high;
  for (const CurveArrangement::Edge& edge : arrangement.edges) {
    const auto [least, most] = extent_along(edge.segment, Vector2d::UnitY());
    low_ = std::min(low_, least);
    high = std::max(high, most);
  }
  height_ = std::max(high - low_, std::numeric_limits<double>::min());
  strips_.resize(std::max<std::size_t>(1, arrangement.edges.size() / 4));
  for (const CurveArrangement::Edge& edge : arrangement.edges) add(edge);
}

void FaceLocator::add(const CurveArrangement::Edge& edge) {
  const ProfileSegment& s = edge.segment;
  if (!s.is_arc()) {
    const double slope = (s.end.x() - s.start.x()) / (s.end.y() - s.start.y());
    add({.low = std::min(s.start.y(), s.end.y()),
         .high = std::max(s.start.y(), s.end.y()),
         .x = s.start.x() - slope * s.start.y(),
         .slope = slope,
         .centre_y = 0,
         .radius = 0,
         .side = 0,
         .face = s.end.y() > s.start.y() ? edge.right : edge.left});
    return;
  }
  // From the start over the top and bottom, as far as the arc passes them, to the end.
  std::vector<double> shares{0, 1};
  for (const double sign : {1.0, -1.0}) {
    const Vector2d pole = s.centre + sign * s.radius * Vector2d::UnitY();
    if (is_in_sector(s, pole - s.centre)) shares.push_back(std::clamp(share_of(s, pole), 0.0, 1.0));
  }
  std::ranges::sort(shares);
  for (std::size_t k = 1; k < shares.size(); ++k) {
    const double from = k == 1 ? s.start.y() : s.at(shares[k - 1]).y();
    const double to = k + 1 == shares.size() ? s.end.y() : s.at(shares[k]).y();
    if (from == to) continue;
    const bool rises = to > from;
    add({.low = std::min(from, to),
         .high = std::max(from, to),
         .x = s.centre.x(),
         .slope = 0,
         .centre_y = s.centre.y(),
         .radius = s.radius,
         .side = rises == (s.bulge > 0) ? 1.0 : -1.0,
         .face = rises ? edge.right : edge.left});
  }
}

void FaceLocator::add(const Flank& flank) {
  for (std::size_t k = strip_of(flank.low); k <= strip_of(flank.high); ++k) strips_[k].push_back(flank);
}

std::size_t FaceLocator::strip_of(double y) const {
  const double share = std::clamp((y - low_) / height_, 0.0, 1.0);
  return std::min(static_cast<std::size_t>(share * static_cast<double>(strips_.size())), strips_.size() - 1);
}

std::uint32_t FaceLocator::face_at(const Vector2d& place) const {
  double nearest_x = -std::numeric_limits<double>::infinity();
  std::uint32_t face = 0;
  for (const Flank& flank : strips_[strip_of(place.y())]) {
    if (!(flank.low <= place.y() && place.y() < flank.high)) continue;
    const double up = place.y() - flank.centre_y;
    const double x = flank.radius == 0
                         ? flank.x + flank.slope * place.y()
                         : flank.x + flank.side * std::sqrt(std::max(0.0, flank.radius * flank.radius - up * up));
    if (x > place.x() || x < nearest_x) continue;
    nearest_x = x;
    face = flank.face;
  }
  return face;
}

}  // namespace cloud2csg
