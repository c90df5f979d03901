#include <ccd/ccd.h>

#include "paper/overlap/narrow_phase.hpp"

// libccd offers GJK and Minkowski portal refinement (MPR). On touching solids, tolerance 1e-6 of their size, its
// GJK misses 20 to 70 % of the contacts (its simplex tests compare squared lengths with an absolute epsilon); its MPR
// misses none of 280 000, needs fewer support points and ends by itself. So MPR it is.

namespace cloud2csg {
namespace {

constexpr unsigned long k_max_iterations = 1000;  // NOLINT(google-runtime-int): libccd's type
/// Progress of the portal below which MPR stops, in units of the pair's size: near the resolution of double.
constexpr double k_portal_tolerance = 1e-13;

/// One body of a pair in libccd's frame: moved and scaled so that the pair is around the origin and of unit size, since
/// libccd compares with absolute epsilons.
struct CcdBody {
  const OverlapBody& body;
  double inflation;
  Eigen::Vector3d origin;
  double scale;
};

ccd_vec3_t to_ccd(const CcdBody& object, const Eigen::Vector3d& world) {
  const Eigen::Vector3d scaled = object.scale * (world - object.origin);
  return {{scaled.x(), scaled.y(), scaled.z()}};
}

void ccd_support(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* result) {
  const auto& body = *static_cast<const CcdBody*>(object);
  Eigen::Vector3d towards(direction->v[0], direction->v[1], direction->v[2]);
  const double length = towards.norm();
  towards = length > 0 ? Eigen::Vector3d(towards / length) : Eigen::Vector3d::UnitX();
  *result = to_ccd(body, support_point(body.body, towards) + body.inflation * towards);
}

void ccd_center(const void* object, ccd_vec3_t* result) {
  const auto& body = *static_cast<const CcdBody*>(object);
  *result = to_ccd(body, body.body.center);
}

}  // namespace

bool convex_bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const AlignedBox both = a.bounds.merged(b.bounds);
  const double size = both.diagonal().norm() + tolerance;
  if (size == 0) return true;
  const double half = tolerance / 2;
  const CcdBody first{.body = a, .inflation = half, .origin = both.center(), .scale = 1 / size};
  const CcdBody second{.body = b, .inflation = half, .origin = both.center(), .scale = 1 / size};
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = ccd_support;
  ccd.center1 = ccd.center2 = ccd_center;
  ccd.max_iterations = k_max_iterations;
  ccd.mpr_tolerance = k_portal_tolerance;
  return ccdMPRIntersect(&first, &second, &ccd) != 0;
}

}  // namespace cloud2csg
