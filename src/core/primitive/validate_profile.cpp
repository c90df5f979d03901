#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/primitive/profile.hpp"
#include "core/primitive/refuse.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

/// Shares of the profile's size that count as touching. Files keep at least nine digits.
constexpr double k_touching = 1e-9;
/// Share of the shorter segment's length that is its corner.
constexpr double k_corner = 1e-6;
/// Beyond it, an arc's gap is less than k_touching of its radius.
constexpr double k_most_bulge = 1e9;

/// Whether the segments come nearer than this to each other, away from corners that they share as neighbours.
bool touch(const ProfileSegment& a, const ProfileSegment& b, std::span<const Vector2d> shared, double tolerance) {
  std::vector<Vector2d> candidates = crossings(a, b, tolerance);
  // One of these points is common to both where they coincide for some way.
  for (const Vector2d& point : {a.start, a.end, a.at(0.5), b.start, b.end, b.at(0.5)}) candidates.push_back(point);
  // At a sharp corner the segments are near each other for some way.
  const double corner = std::max(tolerance, k_corner * std::min(a.length(), b.length()));
  return std::ranges::any_of(candidates, [&](const Vector2d& point) {
    const Vector2d on_a = nearest(a, point);
    if ((nearest(b, on_a) - on_a).norm() > tolerance) return false;
    return std::ranges::none_of(shared, [&](const Vector2d& end) { return (on_a - end).norm() <= corner; });
  });
}

struct PlacedSegment {
  ProfileSegment segment;
  std::size_t path, index;
  Eigen::AlignedBox2d box;
};

/// The corners between two segments if they follow each other in a path of `count`.
std::vector<Vector2d> shared_corners(const PlacedSegment& a, const PlacedSegment& b, std::size_t count) {
  std::vector<Vector2d> shared;
  if (a.path != b.path) return shared;
  if ((a.index + 1) % count == b.index) shared.push_back(b.segment.start);
  if ((b.index + 1) % count == a.index) shared.push_back(a.segment.start);
  return shared;
}

/// All segments, after each was checked for itself.
std::vector<PlacedSegment> checked_segments(const Profile& profile) {
  std::vector<PlacedSegment> all;
  for (std::size_t p = 0; p < profile.paths.size(); ++p) {
    const ClosedPath& path = profile.paths[p];
    if (path.size() < 2) refuse_primitive(fmt::format("profile/{}", p), "a closed path of two corners or more");
    const std::vector<ProfileSegment> segments = segments_of(path);
    for (std::size_t i = 0; i < path.size(); ++i) {
      const std::string where = fmt::format("profile/{}/{}", p, i);
      if (!path[i].point.allFinite() || !std::isfinite(path[i].bulge))
        refuse_primitive(where, "two or three finite numbers");
      if (segments[i].start == segments[i].end) refuse_primitive(where, "a corner that differs from the next one");
      if (std::abs(path[i].bulge) > k_most_bulge) refuse_primitive(where, "an arc that is no full circle");
      all.push_back({.segment = segments[i], .path = p, .index = i, .box = bounds_of(std::span(&segments[i], 1))});
    }
  }
  return all;
}

}  // namespace

void validate_profile(const Profile& profile) {
  if (profile.paths.empty()) refuse_primitive("profile", "a closed path or more");
  const std::vector<PlacedSegment> all = checked_segments(profile);
  const double tolerance = k_touching * bounds_of(profile).diagonal().norm();
  // Only segments whose boxes overlap along x can touch.
  std::vector<std::size_t> by_low(all.size());
  std::iota(by_low.begin(), by_low.end(), std::size_t{0});
  std::ranges::stable_sort(by_low, {}, [&](std::size_t k) { return all[k].box.min().x(); });
  std::pair<std::size_t, std::size_t> first{all.size(),
                                            0};  // of those that touch, the pair whose later segment is first
  for (std::size_t j = 0; j < all.size(); ++j) {
    for (std::size_t i = j + 1; i < all.size(); ++i) {
      if (all[by_low[i]].box.min().x() > all[by_low[j]].box.max().x() + tolerance) break;
      const auto [earlier, later] = std::minmax(by_low[i], by_low[j]);
      const PlacedSegment& a = all[earlier];
      const PlacedSegment& b = all[later];
      if (std::pair(later, earlier) >= first || a.box.exteriorDistance(b.box) > tolerance) continue;
      if (touch(a.segment, b.segment, shared_corners(a, b, profile.paths[a.path].size()), tolerance)) {
        first = {later, earlier};
      }
    }
  }
  if (first.first == all.size()) return;
  const PlacedSegment& a = all[first.second];
  const PlacedSegment& b = all[first.first];
  refuse_primitive(fmt::format("profile/{}/{}", b.path, b.index),
                   fmt::format("a segment that does not cross or touch segment {} of path {}", a.index, a.path));
}

void validate_turned_profile(const Profile& profile) {
  validate_profile(profile);
  const double tolerance = k_touching * bounds_of(profile).diagonal().norm();
  for (std::size_t p = 0; p < profile.paths.size(); ++p) {
    const std::vector<ProfileSegment> segments = segments_of(profile.paths[p]);
    const std::size_t count = segments.size();
    for (std::size_t i = 0; i < count; ++i) {
      const ProfileSegment& s = segments[i];
      const double low = extent_along(s, Vector2d::UnitX()).first;
      const std::string where = fmt::format("profile/{}/{}", p, i);
      if (low < -tolerance) refuse_primitive(where, "radii of 0 or more");
      const bool starts_at_line = s.start.x() == 0 && segments[(i + count - 1) % count].is_on_axis();
      const bool ends_at_line = s.end.x() == 0 && segments[(i + 1) % count].is_on_axis();
      if (low > tolerance || s.is_on_axis() || starts_at_line || ends_at_line) continue;
      refuse_primitive(where, "a profile that does not touch the axis in a single point");
    }
  }
}

}  // namespace cloud2csg
