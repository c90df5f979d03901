#include "raw/solids/sectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>

#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Ten degrees: a narrower gap is a slot. Ends are as inexact, because pieces that continue each other smoothly, such
/// as two bends of a pipe, share the points where they meet.
constexpr double k_gap = 0.175;
/// In mean distances of angles. Of n random angles, n e^-10 have a wider gap by chance.
constexpr double k_chance_gap = 10;
constexpr std::size_t k_most_points = 2000;  // more tell no better where a surface ends
constexpr std::size_t k_most_ends = 6;
constexpr double k_level = 0.0175;  // the sine of a degree

double angle_of(const Vector2d& place) {
  return std::atan2(place.y(), place.x());
}

/// Between -pi and pi.
double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// The angles of a surface's points, ascending, without those in thinly filled bins: noise carries points beyond an
/// end.
std::vector<double> angles_of(const Pose& frame, const Points& positions, const DetectedSurface& surface) {
  constexpr std::size_t k_bins = 72;
  constexpr double k_thin = 0.3;  // of the average
  std::vector<double> angles;
  for (const std::uint32_t i : some_of(surface.points, k_most_points)) {
    angles.push_back(angle_of(frame.to_local(positions[i]).head<2>()));
  }
  std::array<std::size_t, k_bins> counts{};
  const auto bin_of = [](double angle) {
    const double share = 0.5 + angle / (2 * std::numbers::pi);
    return std::min(static_cast<std::size_t>(share * k_bins), k_bins - 1);
  };
  for (const double angle : angles) ++counts[bin_of(angle)];
  const auto filled = k_bins - static_cast<std::size_t>(std::ranges::count(counts, std::size_t{0}));
  const double least = k_thin * static_cast<double>(angles.size()) / static_cast<double>(filled);
  std::erase_if(angles, [&](double angle) { return static_cast<double>(counts[bin_of(angle)]) < least; });
  std::ranges::sort(angles);
  return angles;
}

/// Halfway between the last point and where the next would be at most, so that no point is exactly at an end.
std::vector<double> ends_of(std::span<const double> angles) {
  const double step = 2 * std::numbers::pi / static_cast<double>(angles.size() + 1);
  const double least = std::max(k_gap, k_chance_gap * step);
  std::vector<double> ends;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const bool is_last = k + 1 == angles.size();
    const double next = is_last ? angles.front() + 2 * std::numbers::pi : angles[k + 1];
    if (next - angles[k] > least) {
      ends.insert(ends.end(), {wrapped(angles[k] + 0.5 * step), wrapped(next - 0.5 * step)});
    }
  }
  return ends;
}

/// Whether a torus goes on at a place on the middle of a bend: both are as thick, and its middle passes there.
bool goes_on_at(const Surface& torus, const Vector3d& place, double minor_radius) {
  constexpr double k_share = 0.2;  // of the minor radius
  const Vector3d way = place - torus.position;
  const double height = torus.axis.dot(way);
  const double off = std::hypot((way - height * torus.axis).norm() - torus.radius, height);
  return off < k_share * minor_radius && std::abs(torus.minor_radius - minor_radius) < k_share * minor_radius;
}

/// Where a bend ends and a straight pipe goes on: at the point of the pipe's axis nearest to the centre of the torus.
/// Absent for other surfaces.
std::optional<Vector3d> start_of_pipe(const Surface& torus, const Surface& pipe) {
  if (torus.type != SurfaceType::torus || pipe.type != SurfaceType::cylinder) return std::nullopt;
  if (std::abs(pipe.axis.dot(torus.axis)) > k_level) return std::nullopt;
  const Vector3d start = pipe.position + pipe.axis.dot(torus.position - pipe.position) * pipe.axis;
  return goes_on_at(torus, start, pipe.radius) ? std::optional(start) : std::nullopt;
}

/// Where a surface is likely to end: along planes through the axis, and where another bend or a pipe goes on.
std::vector<double> likely_ends(const Pose& frame, const Surface& surface, std::span<const DetectedSurface> surfaces,
                                double tolerance) {
  std::vector<double> likely;
  for (const DetectedSurface& s : surfaces) {
    const Vector3d axis = frame.orientation.conjugate() * s.surface.axis;
    const Vector3d place = frame.to_local(s.surface.position);
    const bool is_through_axis = std::abs(axis.z()) < k_level && std::abs(axis.dot(place)) < tolerance;
    const bool are_bends = s.surface.type == SurfaceType::torus && surface.type == SurfaceType::torus;
    if (s.surface.type == SurfaceType::plane && is_through_axis) {
      const double angle = angle_of(Vector2d(-axis.y(), axis.x()));
      likely.insert(likely.end(), {angle, wrapped(angle + std::numbers::pi)});
    } else if (const std::optional<Vector3d> start = start_of_pipe(surface, s.surface)) {
      likely.push_back(angle_of(frame.to_local(*start).head<2>()));
    } else if (are_bends && place.head<2>().norm() > tolerance) {
      for (const double side : {1.0, -1.0}) {
        const Vector2d towards = side * place.head<2>().normalized();
        const Vector3d way = frame.orientation * Vector3d(towards.x(), towards.y(), 0);
        if (goes_on_at(s.surface, surface.position + surface.radius * way, surface.minor_radius)) {
          likely.push_back(angle_of(towards));
        }
      }
    }
  }
  return likely;
}

/// Points within k_gap of an angle, on the side with fewer.
std::size_t count_across(double end, std::span<const std::vector<double>> angles) {
  std::size_t before = 0;
  std::size_t behind = 0;
  for (const std::vector<double>& of_surface : angles) {
    for (const double angle : of_surface) {
      const double off = wrapped(angle - end);
      before += off < 0 && off > -k_gap ? 1 : 0;
      behind += off >= 0 && off < k_gap ? 1 : 0;
    }
  }
  return std::min(before, behind);
}

}  // namespace

std::vector<double> sector_ends(const Pose& frame, const Points& positions,
                                std::vector<const DetectedSurface*> revolved, std::span<const DetectedSurface> surfaces,
                                double tolerance) {
  std::ranges::stable_sort(revolved, std::greater<>(), [](const DetectedSurface* s) { return s->points.size(); });
  std::vector<std::vector<double>> angles;
  std::vector<double> ends;
  for (const DetectedSurface* detected : revolved) {
    angles.push_back(angles_of(frame, positions, *detected));
    const std::vector<double> likely = likely_ends(frame, detected->surface, surfaces, tolerance);
    for (double end : ends_of(angles.back())) {
      const auto distance = [end](double other) { return std::abs(wrapped(other - end)); };
      const auto nearest = std::ranges::min_element(likely, {}, distance);
      if (nearest != likely.end() && distance(*nearest) < k_gap) end = *nearest;
      const auto is_known = [end](double other) { return std::abs(wrapped(other - end)) < k_gap / 2; };
      if (ends.size() < k_most_ends && std::ranges::none_of(ends, is_known)) ends.push_back(end);
    }
  }
  std::ranges::stable_sort(ends, {}, [&](double end) { return count_across(end, angles); });
  return ends;
}

}  // namespace cloud2csg
