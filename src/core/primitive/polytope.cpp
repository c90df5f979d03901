#include "core/primitive/polytope.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/primitive/refuse.hpp"

namespace cloud2csg {
namespace {

/// Three planes whose normals span a smaller volume meet too far away, or not at all.
constexpr double k_parallel = 1e-9;

/// The distance from a plane up to which a point lies on it.
double tolerance_of(const Polytope& polytope) {
  double largest = 0;
  for (const Plane& plane : polytope.planes) largest = std::max(largest, std::abs(plane.offset));
  return 1e-9 * largest;
}

bool is_within(const Polytope& polytope, const Eigen::Vector3d& point, double tolerance) {
  return std::ranges::all_of(polytope.planes,
                             [&](const Plane& plane) { return plane.normal.dot(point) <= plane.offset + tolerance; });
}

/// Whether some direction never meets a plane: one along two of the planes, unless the normals do not span space.
bool is_unbounded(const Polytope& polytope) {
  const std::vector<Plane>& planes = polytope.planes;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Plane& plane : planes) spread += plane.normal * plane.normal.transpose();
  if (spread.determinant() < k_parallel) return true;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const Eigen::Vector3d edge = planes[a].normal.cross(planes[b].normal);
      if (edge.squaredNorm() < k_parallel * k_parallel) continue;
      for (const double sign : {1.0, -1.0}) {
        const Eigen::Vector3d direction = sign * edge.normalized();
        const bool escapes =
            std::ranges::all_of(planes, [&](const Plane& plane) { return plane.normal.dot(direction) <= k_parallel; });
        if (escapes) return true;
      }
    }
  }
  return false;
}

void validate_plane(const Plane& plane, std::size_t index) {
  const std::string where = fmt::format("planes/{}", index);
  if (!plane.normal.allFinite() || !std::isfinite(plane.offset)) refuse_primitive(where, "four finite numbers");
  const double length = plane.normal.norm();
  if (std::abs(length - 1) > 1e-6) {
    refuse_primitive(where, fmt::format("a normal of unit length, not {:.9g}", length),
                     "divide the normal and the offset by that length");
  }
}

/// The corners on one plane, in order around it.
std::vector<std::size_t> corners_on(const Plane& plane, const std::vector<Eigen::Vector3d>& corners, double tolerance) {
  std::vector<std::size_t> on_plane;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(plane.normal.dot(corners[i]) - plane.offset) > tolerance) continue;
    on_plane.push_back(i);
    centre += corners[i];
  }
  centre /= std::max(1.0, static_cast<double>(on_plane.size()));
  const Eigen::Vector3d u = plane.normal.unitOrthogonal();
  const Eigen::Vector3d v = plane.normal.cross(u);
  const auto angle = [&](std::size_t i) { return std::atan2(v.dot(corners[i] - centre), u.dot(corners[i] - centre)); };
  std::sort(on_plane.begin(), on_plane.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  return on_plane;
}

}  // namespace

std::vector<Eigen::Vector3d> corners(const Polytope& polytope) {
  const std::vector<Plane>& planes = polytope.planes;
  const double tolerance = tolerance_of(polytope);
  std::vector<Eigen::Vector3d> found;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    for (std::size_t b = a + 1; b < planes.size(); ++b) {
      const Eigen::Vector3d edge = planes[a].normal.cross(planes[b].normal);
      for (std::size_t c = b + 1; c < planes.size(); ++c) {
        const double volume = edge.dot(planes[c].normal);
        if (std::abs(volume) < k_parallel) continue;
        const Eigen::Vector3d corner =
            (planes[a].offset * planes[b].normal.cross(planes[c].normal) +
             planes[b].offset * planes[c].normal.cross(planes[a].normal) + planes[c].offset * edge) /
            volume;
        // Where more than three planes meet, every three of them give the same corner.
        const bool is_known = std::ranges::any_of(found, [&](const Eigen::Vector3d& other) {
          return (other - corner).squaredNorm() <= tolerance * tolerance;
        });
        if (!is_known && is_within(polytope, corner, tolerance)) found.push_back(corner);
      }
    }
  }
  return found;
}

Polytope grown(const Polytope& polytope, double distance) {
  Polytope result = polytope;
  for (Plane& plane : result.planes) plane.offset += distance;
  return result;
}

void validate_polytope(const Polytope& polytope) {
  for (std::size_t i = 0; i < polytope.planes.size(); ++i) validate_plane(polytope.planes[i], i);
  if (polytope.planes.size() < 4) {
    refuse_primitive("planes", fmt::format("at least 4 planes, not {}", polytope.planes.size()),
                     "a bounded solid needs four");
  }
  if (is_unbounded(polytope)) {
    refuse_primitive("planes", "planes that enclose a bounded solid", "add the missing sides");
  }

  const std::vector<Eigen::Vector3d> points = corners(polytope);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : points) middle += corner / static_cast<double>(points.size());
  // The mean of the corners is strictly inside exactly when the solid has volume.
  if (points.size() < 4 || !is_within(polytope, middle, -tolerance_of(polytope))) {
    refuse_primitive("planes", "planes whose half-spaces have a common volume",
                     "check the signs of normals and offsets");
  }
}

PolytopeFaces faces_of(const Polytope& polytope) {
  constexpr double k_on_plane = 1e-9;  // as a share of the size
  PolytopeFaces result{.corners = corners(polytope), .faces = {}};
  AlignedBox box;
  for (const Eigen::Vector3d& corner : result.corners) box.extend(corner);
  for (const Plane& plane : polytope.planes) {
    std::vector<std::size_t> face = corners_on(plane, result.corners, k_on_plane * box.diagonal().norm());
    if (face.size() >= 3 && std::find(result.faces.begin(), result.faces.end(), face) == result.faces.end())
      result.faces.push_back(std::move(face));
  }
  return result;
}

}  // namespace cloud2csg
