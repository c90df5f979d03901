#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "cloud2csg/advanced/surface.hpp"
#include "raw/prepare/constants.hpp"

namespace cloud2csg {

struct OrientedPoint {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< unit length, outward
  double precision = 1;    ///< the cloud's noise over the point's own
};

/// A point's signed distance from a surface times its precision, and the cosine between the point's normal and the
/// surface's.
struct Agreement {
  double distance, cosine;
};

/// A surface is no chance if the logarithm of its likelihood ratio is at least this. e^14 is about a million.
constexpr double k_evidence = 14;

/// How many values of a surface the points must determine: 3 for a plane to 7 for a torus.
constexpr std::size_t count_parameters(SurfaceType type) {
  constexpr std::array<std::size_t, 5> k_counts{3, 4, 5, 6, 7};
  return k_counts[static_cast<std::size_t>(type)];
}

/// The least evidence for a surface of `points` points: what its parameters fit by chance does not count (BIC).
inline double least_evidence(SurfaceType type, std::size_t points) {
  return k_evidence + 0.5 * static_cast<double>(count_parameters(type)) * std::log(static_cast<double>(points));
}

/// Negative logarithm of the likelihood of a distance with normally distributed noise, up to a constant. A distance of
/// more than three standard deviations counts as that: then the point is an outlier.
inline double cost_of(double distance, double noise) {
  const double off = std::min(std::abs(distance / noise), k_deviations);
  return off * off / 2;
}

/// In a cloud of diagonal 1; a larger surface counts as flat.
constexpr double k_flat_radius = 3;

/// Limits within which a point lies on a surface.
struct AgreementLimits {
  double distance;  ///< greatest absolute value, for the noise and a form error, such as that of facets
  double noise;     ///< standard deviation of the points of an exact surface; at most `distance`
  double cosine;    ///< least value
  double most_radius = k_flat_radius;

  /// A function of an Agreement, the weight of the point: 1 on the surface with its normal, falling to 0 at either
  /// limit. Over the distance it is the logarithm of a density whose scale is unknown between noise and form error
  /// (Jeffreys' prior): a surface that passes through the points within the noise is much better than one that passes
  /// by them within the form error.
  [[nodiscard]] auto support() const {
    const double most = distance / noise;
    return [limits = *this, range = std::log1p(most * most)](const Agreement& agreement) -> double {
      if (!limits.hold(agreement)) return 0;
      const double off = agreement.distance / limits.noise;
      return (1 - std::log1p(off * off) / range) * (agreement.cosine - limits.cosine) / (1 - limits.cosine);
    };
  }
  /// The same for a surface whose own points reach less far.
  [[nodiscard]] AgreementLimits within(double reach) const {
    AgreementLimits result = *this;
    result.distance = reach;
    return result;
  }
  /// The same for points of this precision, whose distances do not count times it.
  [[nodiscard]] AgreementLimits at(double precision) const {
    AgreementLimits result = *this;
    result.distance /= precision;
    result.noise /= precision;
    return result;
  }
  [[nodiscard]] bool hold(const Agreement& agreement) const {
    return std::abs(agreement.distance) <= distance && agreement.cosine >= cosine;
  }
};

/// Calls function(rule) and returns its result. rule(point) gives an Agreement by signed_distance() and normal() of the
/// surface. This dispatches on the type once, not for each point.
template <class Function>
auto with_agreement(const Surface& s, const Function& function) {
  const auto f = [&](const auto& rule) {
    return function([&](const OrientedPoint& p) -> Agreement {
      Agreement agreement = rule(p.position, p.normal);
      agreement.distance *= p.precision;
      return agreement;
    });
  };
  using Vector = Eigen::Vector3d;
  const double tiny = 1e-300;  // replaces zero where the surface has no normal
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
  return f([&](const Vector& x, const Vector& n) -> Agreement {
    const Vector v = x - s.position;
    const double height = s.axis.dot(v);
    const Vector across = v - height * s.axis;
    const double radial = across.norm();
    const Vector outward = (radial - s.radius) / std::max(radial, tiny) * across + height * s.axis;
    const double length =
        std::sqrt((radial - s.radius) * (radial - s.radius) + height * height);  // also right on the axis
    return {side * (length - s.minor_radius), side * outward.dot(n) / std::max(length, tiny)};
  });
}

/// Sum of the points' support. Unlike the number of agreeing points, it prefers a surface through the middle of the
/// points (after MLESAC: Torr and Zisserman 2000). O(n)
[[nodiscard]] double support_of(const Surface& surface, std::span<const OrientedPoint> points,
                                const AgreementLimits& limits);

/// Number of points on the surface. O(n)
[[nodiscard]] std::size_t count_agreeing(const Surface& surface, std::span<const OrientedPoint> points,
                                         const AgreementLimits& limits);

/// cost_of() each point on the surface with this noise. One whose normal is on another side of an edge is an outlier.
[[nodiscard]] std::vector<double> costs_of(const Surface& surface, std::span<const OrientedPoint> points, double noise);

[[nodiscard]] std::vector<OrientedPoint> agreeing_points(const Surface& surface, std::span<const OrientedPoint> points,
                                                         const AgreementLimits& limits);

}  // namespace cloud2csg
