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

std::vector<double> costs_of(const Surface& surface, std::span<const OrientedPoint> points, double noise) {
  return with_agreement(surface, [&](const auto& rule) {
    std::vector<double> costs;
    costs.reserve(points.size());
    for (const OrientedPoint& p : points) {
      const Agreement agreement = rule(p);
      costs.push_back(cost_of(agreement.cosine >= k_edge_cosine ? agreement.distance : k_deviations * noise, noise));
    }
    return costs;
  });
}

}  // namespace cloud2csg
