#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"

namespace cloud2csg {

struct OrientedPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< unit length, outward
};

/// What a surface says of a point with its normal: the signed distance, and the cosine between the surface's normal
/// there and the point's.
struct Agreement {
  double distance, cosine;
};

/// When a point lies on a surface.
struct AgreementLimits {
  double distance;         ///< at most, on either side
  double cosine;           ///< at least
  double most_radius = 3;  ///< of surfaces in a cloud of diagonal one: what is larger is flat

  /// How well they hold: from 1 for a point on the surface with the surface's normal down to 0 at either limit.
  [[nodiscard]] double support(const Agreement& agreement) const {
    if (!hold(agreement)) return 0;
    const double off = agreement.distance / distance;
    return (1 - off * off) * (agreement.cosine - cosine) / (1 - cosine);
  }
  [[nodiscard]] bool hold(const Agreement& agreement) const {
    return std::abs(agreement.distance) <= distance && agreement.cosine >= cosine;
  }
};

/// Calls f(rule), where rule(position, normal) is an Agreement with signed_distance() and normal() of the surface: the
/// type is looked at once, not for each point. What it returns is what f does.
template <class Function>
auto with_agreement(const Surface& s, const Function& f) {
  using Vector = Eigen::Vector3d;
  const double tiny = 1e-300;  // instead of zero, where a place has no normal
  const double side = s.concave && s.type != SurfaceType::plane ? -1 : 1;
  const auto round = [side, tiny](const Vector& v, const Vector& n, double radius) -> Agreement {
    const double length = std::max(v.norm(), tiny);
    return {side * (length - radius), side * v.dot(n) / length};
  };
  switch (s.type) {
    case SurfaceType::plane:
      return f([&](const Vector& x, const Vector& n) -> Agreement {
        return {s.axis.dot(x - s.position), s.axis.dot(n)};
      });
    case SurfaceType::sphere:
      return f([&](const Vector& x, const Vector& n) { return round(x - s.position, n, s.radius); });
    case SurfaceType::cylinder:
      return f([&](const Vector& x, const Vector& n) {
        const Vector v = x - s.position;
        return round(v - s.axis.dot(v) * s.axis, n, s.radius);
      });
    case SurfaceType::cone:
      return f([&, sine = std::sin(s.half_angle), cosine = std::cos(s.half_angle)](const Vector& x, const Vector& n) {
        const Vector v = x - s.position;
        const double height = s.axis.dot(v);
        const Vector across = v - height * s.axis;
        const double radial = std::max(across.norm(), tiny);
        if (height * cosine + radial * sine < 0) return round(v, n, 0);
        return Agreement{side * (radial * cosine - height * sine),
                         side * (across.dot(n) / radial * cosine - s.axis.dot(n) * sine)};
      });
    case SurfaceType::torus:
      break;
  }
  return f([&](const Vector& x, const Vector& n) {
    const Vector v = x - s.position;
    const Vector across = v - s.axis.dot(v) * s.axis;
    return round(v - s.radius / std::max(across.norm(), tiny) * across, n, s.minor_radius);
  });
}

/// The sum of what the points support. Unlike their number it tells a surface through the middle of the points from one
/// that just has them within its limits (MSAC: Torr and Zisserman 2000). O(n)
[[nodiscard]] double support_of(const Surface& surface, std::span<const OrientedPoint> points,
                                const AgreementLimits& limits);

/// How many of the points lie on the surface. O(n)
[[nodiscard]] std::size_t count_agreeing(const Surface& surface, std::span<const OrientedPoint> points,
                                         const AgreementLimits& limits);

/// Those that do.
[[nodiscard]] std::vector<OrientedPoint> agreeing_points(const Surface& surface, std::span<const OrientedPoint> points,
                                                         const AgreementLimits& limits);

}  // namespace cloud2csg
