#include "raw/detect/agreement.hpp"

namespace cloud2csg {

double support_of(const Surface& surface, std::span<const OrientedPoint> points, const AgreementLimits& limits) {
  return with_agreement(surface, [&, support = limits.support()](const auto& rule) {
    double sum = 0;
    for (const OrientedPoint& p : points) sum += support(rule(p));
    return sum;
  });
}

std::size_t count_agreeing(const Surface& surface, std::span<const OrientedPoint> points,
                           const AgreementLimits& limits) {
  return with_agreement(surface, [&](const auto& rule) {
    std::size_t count = 0;
    for (const OrientedPoint& p : points) count += limits.hold(rule(p)) ? 1U : 0U;
    return count;
  });
}

std::vector<OrientedPoint> agreeing_points(const Surface& surface, std::span<const OrientedPoint> points,
                                           const AgreementLimits& limits) {
  return with_agreement(surface, [&](const auto& rule) {
    std::vector<OrientedPoint> agreeing;
    agreeing.reserve(points.size());
    for (const OrientedPoint& p : points) {
      if (limits.hold(rule(p))) agreeing.push_back(p);
    }
    return agreeing;
  });
}

}  // namespace cloud2csg
