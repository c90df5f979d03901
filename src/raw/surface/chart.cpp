#include "raw/surface/chart.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace cloud2csg {
namespace {

constexpr double k_least_half_angle = 1e-4;  // a narrower cone is a cylinder, whose apex has no significant digits

}  // namespace

Chart::Chart(const Surface& start) : start_(start) {
  const Eigen::Vector3d& axis = start.axis;
  const Eigen::Vector3d first = axis.unitOrthogonal();
  directions_ = {first, axis.cross(first), axis};
  // The origin is the centroid. The position becomes the point of the axis or plane nearest to it.
  const double along = axis.dot(start.position);
  switch (start.type) {
    case SurfaceType::plane:
      tilts_ = 2, shifts_begin_ = 2, shifts_ = 1, sizes_ = 0;
      start_.position = along * axis;
      break;
    case SurfaceType::sphere:
      tilts_ = 0, shifts_ = 3, sizes_ = 1;
      start_sizes_ = {start.radius};
      break;
    case SurfaceType::cylinder:
      tilts_ = 2, shifts_ = 2, sizes_ = 1;
      start_.position -= along * axis;
      start_sizes_ = {start.radius};
      break;
    case SurfaceType::cone:
      tilts_ = 2, shifts_ = 2, sizes_ = 2;
      start_.position -= along * axis;
      start_sizes_ = {-along * std::sin(start.half_angle), start.half_angle};
      break;
    case SurfaceType::torus:
      tilts_ = 2, shifts_ = 3, sizes_ = 2;
      start_sizes_ = {start.radius, start.minor_radius};
      break;
  }
}

Chart::Row Chart::start() const {
  Row row = {};
  for (std::size_t i = 0; i < sizes_; ++i) row[sizes_begin() + i] = start_sizes_[i];
  return row;
}

Chart::Place Chart::at(std::span<const double> values) const {
  assert(values.size() == unknowns());
  Place place{
      .position = start_.position, .axis = start_.axis, .axis_by_tilt = {}, .sizes = {}, .sine = 0, .cosine = 1};
  std::size_t next = 0;
  if (tilts_ > 0) {
    const Eigen::Vector3d tilted = start_.axis + values[0] * directions_[0] + values[1] * directions_[1];
    const double length = tilted.norm();
    place.axis = tilted / length;
    for (std::size_t i = 0; i < 2; ++i) {
      place.axis_by_tilt[i] = (directions_[i] - place.axis.dot(directions_[i]) * place.axis) / length;
    }
    next = 2;
  }
  for (std::size_t i = 0; i < shifts_; ++i) {
    place.position += values[next++] * directions_[shifts_begin_ + i];
  }
  for (std::size_t i = 0; i < sizes_; ++i) place.sizes[i] = values[next++];
  if (start_.type == SurfaceType::cone) {
    place.sine = std::sin(place.sizes[1]);
    place.cosine = std::cos(place.sizes[1]);
  }
  return place;
}

bool Chart::is_surface(const Place& place) const {
  if (!place.position.allFinite() || !place.axis.allFinite()) return false;
  switch (start_.type) {
    case SurfaceType::plane:
      return true;
    case SurfaceType::sphere:
    case SurfaceType::cylinder:
      return std::isfinite(place.sizes[0]) && place.sizes[0] > 0;
    case SurfaceType::cone: {
      const double opening = std::abs(place.sizes[1]);
      return std::isfinite(place.sizes[0]) && opening >= k_least_half_angle &&
             opening <= std::numbers::pi / 2 - k_least_half_angle;
    }
    case SurfaceType::torus:
      return std::isfinite(place.sizes[0]) && std::isfinite(place.sizes[1]) && place.sizes[1] > 0 &&
             place.sizes[0] + place.sizes[1] > 0;
  }
  return false;
}

Surface Chart::surface(const Place& place) const {
  Surface surface = start_;
  surface.position = place.position;
  surface.axis = place.axis;
  switch (start_.type) {
    case SurfaceType::plane:
      surface.position = place.position.dot(place.axis) * place.axis;
      break;
    case SurfaceType::sphere:
      surface.radius = place.sizes[0];
      break;
    case SurfaceType::cylinder:
      surface.position -= place.position.dot(place.axis) * place.axis;
      surface.radius = place.sizes[0];
      break;
    case SurfaceType::cone:
      surface.position -= place.sizes[0] / place.sine * place.axis;
      surface.half_angle = std::abs(place.sizes[1]);
      // A cone that the fit turned inside out opens the other way.
      if (place.sizes[1] < 0) surface.axis = -place.axis;
      break;
    case SurfaceType::torus:
      surface.radius = place.sizes[0];
      surface.minor_radius = place.sizes[1];
      break;
  }
  return surface;
}

}  // namespace cloud2csg
