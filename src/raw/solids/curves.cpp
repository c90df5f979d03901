#include "raw/solids/curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace cloud2csg {
namespace {

using Eigen::Vector2d;

constexpr double k_least_arc_reach = 0.35;  // beyond the points of a circle, in radians

bool is_same(const Curve& a, const Curve& b, double tolerance) {
  if (a.is_circle != b.is_circle) return false;
  if (a.is_circle) return (a.normal - b.normal).norm() < tolerance && std::abs(a.offset - b.offset) < tolerance;
  // A line is what it is near the other's points.
  return std::abs(a.normal.dot(b.normal)) > 0.999 &&
         std::ranges::all_of(b.points, [&](const Vector2d& p) { return a.distance(p) < 2 * tolerance; });
}

/// The place on a curve that is nearest to a circle beside or inside it.
std::optional<Vector2d> nearest_place(const Curve& curve, const Curve& circle) {
  if (!curve.is_circle) return circle.normal + (curve.offset - curve.normal.dot(circle.normal)) * curve.normal;
  const Vector2d arm = circle.normal - curve.normal;
  if (arm.norm() <= 1e-9 * curve.offset) return std::nullopt;
  return curve.normal + curve.offset * arm.normalized();
}

}  // namespace

std::vector<Curve> merged(std::vector<Curve> curves, double tolerance) {
  std::ranges::stable_sort(curves, std::greater<>(), &Curve::count);
  std::vector<Curve> result;
  for (Curve& curve : curves) {
    const auto known =
        std::ranges::find_if(result, [&](const Curve& other) { return is_same(other, curve, tolerance); });
    if (known == result.end()) {
      result.push_back(std::move(curve));
    } else {
      known->points.insert(known->points.end(), curve.points.begin(), curve.points.end());
      known->count += curve.count;
    }
  }
  return result;
}

std::vector<Curve> with_closed_gaps(std::vector<Curve> curves, double reach, double tolerance) {
  std::vector<std::vector<ProfileSegment>> pieces;
  pieces.reserve(curves.size());
  for (const Curve& curve : curves) pieces.push_back(pieces_of(curve, reach));
  const auto is_on = [&](std::size_t c, const Vector2d& place) {
    return std::ranges::any_of(
        pieces[c], [&](const ProfileSegment& piece) { return (nearest(piece, place) - place).norm() <= tolerance; });
  };
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!curves[c].is_circle) continue;
    double most = 0;
    for (std::size_t k = 0; k < curves.size(); ++k) {
      const std::optional<Vector2d> place = k == c ? std::nullopt : nearest_place(curves[k], curves[c]);
      if (!place) continue;
      const double gap = (*place - curves[c].normal).norm() - curves[c].offset;
      if (gap > most && gap <= tolerance && is_on(c, *place) && is_on(k, *place)) most = gap;
    }
    curves[c].offset += most;
  }
  return curves;
}

std::vector<ProfileSegment> pieces_of(const Curve& curve, double reach) {
  std::vector<double> along;
  for (const Vector2d& p : curve.points) along.push_back(curve.along(p));
  std::ranges::sort(along);
  if (along.empty()) return {};
  if (!curve.is_circle) {
    const Vector2d direction = to_the_left(curve.normal);
    const Vector2d foot = curve.offset * curve.normal;
    return {segment_between(foot + (along.front() - reach) * direction, 0, foot + (along.back() + reach) * direction)};
  }
  const double around = 2 * std::numbers::pi * curve.offset;
  double gap = along.front() + around - along.back();
  double start = along.front();
  for (std::size_t k = 1; k < along.size(); ++k) {
    if (along[k] - along[k - 1] <= gap) continue;
    gap = along[k] - along[k - 1];
    start = along[k];
  }
  const double more = std::max(reach, k_least_arc_reach * curve.offset);
  double length = around - gap + 2 * more;
  start -= more;
  if (length > 0.95 * around) length = around;
  const auto at = [&](double share) {
    const double angle = (start + share * length) / curve.offset;
    return Vector2d(curve.normal + curve.offset * Vector2d(std::cos(angle), std::sin(angle)));
  };
  const double bulge = std::tan(length / curve.offset / 8);  // of a half
  return {segment_between(at(0), bulge, at(0.5)), segment_between(at(0.5), bulge, at(1))};
}

double bare_length(const ProfileSegment& piece, const Curve& curve, double near) {
  if (curve.count == 0) return piece.length();
  constexpr std::array k_probes{0.1, 0.3, 0.5, 0.7, 0.9};
  std::size_t bare = 0;
  for (const double share : k_probes) {
    const Vector2d probe = piece.at(share);
    bare += std::ranges::none_of(curve.points, [&](const Vector2d& p) { return (p - probe).norm() < near; }) ? 1 : 0;
  }
  return piece.length() * static_cast<double>(bare) / k_probes.size();
}

}  // namespace cloud2csg
