#include "raw/solids/sectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>

#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Ten degrees. A narrower gap is a slot, or chance. Ends are as inexact: pieces that continue each other smoothly,
/// such as two bends of a pipe, share the points where they meet.
constexpr double k_gap = 0.175;
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
  const auto filled = std::ranges::count_if(counts, [](std::size_t count) { return count > 0; });
  const double least = k_thin * static_cast<double>(angles.size()) / static_cast<double>(filled);
  std::erase_if(angles, [&](double angle) { return static_cast<double>(counts[bin_of(angle)]) < least; });
  std::ranges::sort(angles);
  return angles;
}

std::vector<double> ends_of_points(const Pose& frame, const Points& positions, const DetectedSurface& surface) {
  const std::vector<double> angles = angles_of(frame, positions, surface);
  // The mean distance of angles, or less: no point is exactly at an end.
  const double step = std::min(k_gap / 4, 2 * std::numbers::pi / static_cast<double>(angles.size() + 1));
  std::vector<double> ends;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const bool is_last = k + 1 == angles.size();
    const double next = is_last ? angles.front() + 2 * std::numbers::pi : angles[k + 1];
    if (next - angles[k] > k_gap) ends.insert(ends.end(), {wrapped(angles[k] + step), wrapped(next - step)});
  }
  return ends;
}

/// Where ends are likely to be: along planes through the axis, and towards the centres of other bends.
std::vector<double> likely_ends(const Pose& frame, std::span<const DetectedSurface> surfaces, double tolerance) {
  std::vector<double> likely;
  const auto add = [&](const Vector2d& direction) {
    likely.insert(likely.end(), {angle_of(direction), angle_of(-direction)});
  };
  for (const DetectedSurface& s : surfaces) {
    const Vector3d axis = frame.orientation.conjugate() * s.surface.axis;
    const Vector3d place = frame.to_local(s.surface.position);
    if (s.surface.type == SurfaceType::plane && std::abs(axis.z()) < k_level && std::abs(axis.dot(place)) < tolerance) {
      add(Vector2d(-axis.y(), axis.x()));
    } else if (s.surface.type == SurfaceType::torus && place.head<2>().norm() > tolerance) {
      add(place.head<2>());
    }
  }
  return likely;
}

}  // namespace

std::vector<double> sector_ends(const Pose& frame, const Points& positions,
                                std::vector<const DetectedSurface*> revolved, std::span<const DetectedSurface> surfaces,
                                double tolerance) {
  std::ranges::stable_sort(revolved, std::greater<>(), [](const DetectedSurface* s) { return s->points.size(); });
  const std::vector<double> likely = likely_ends(frame, surfaces, tolerance);
  std::vector<double> ends;
  for (const DetectedSurface* surface : revolved) {
    for (double end : ends_of_points(frame, positions, *surface)) {
      const auto distance = [end](double other) { return std::abs(wrapped(other - end)); };
      const auto nearest = std::ranges::min_element(likely, {}, distance);
      if (nearest != likely.end() && distance(*nearest) < k_gap) end = *nearest;
      const auto is_known = [end](double other) { return std::abs(wrapped(other - end)) < k_gap / 2; };
      if (ends.size() < k_most_ends && std::ranges::none_of(ends, is_known)) ends.push_back(end);
    }
  }
  return ends;
}

}  // namespace cloud2csg
