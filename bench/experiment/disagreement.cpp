#include <numeric>

#include "bench/experiment/scaling.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/boxes.hpp"
#include "shape/sample/neighbourhood.hpp"
#include "shape/sample/primitive_surface.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_stream = 0x646966666572'00;
/// Per primitive: this many places on either side of its surface and this many within its bounds.
constexpr std::size_t k_places = 64;

Points places_around(const Primitive& primitive, double offset, RandomStream& random) {
  const AlignedBox box = bounds(primitive);
  const PrimitiveSurface surface = make_surface(primitive, box, {});
  Points places;
  for (std::size_t i = 0; i < k_places && surface.area > 0; ++i) {
    const SurfacePoint point = surface.draw(random);
    places.push_back(point.position + offset * point.normal);
    places.push_back(point.position - offset * point.normal);
    places.push_back(random_between(box.min(), box.max(), random));
  }
  return places;
}

}  // namespace

Disagreement disagreement(const CsgTree& a, const CsgTree& b, const PrimitiveSet& primitives, double offset,
                          std::uint64_t seed, const RunContext& run) {
  std::vector<PrimitiveIndex> all(primitives.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  const std::vector<Neighbourhood> of_a = neighbourhoods({.primitives = primitives, .tree = a}, all, offset);
  const std::vector<Neighbourhood> of_b = neighbourhoods({.primitives = primitives, .tree = b}, all, offset);
  std::vector<double> shares(primitives.size());
  for_each_index(primitives.size(), run, [&](std::size_t p) {
    RandomStream random(seed, k_stream, p);
    const Points places = places_around(primitives[p], offset, random);
    const std::vector<double> in_a = implicit_value(of_a[p].tree, of_a[p].primitives, places);
    const std::vector<double> in_b = implicit_value(of_b[p].tree, of_b[p].primitives, places);
    std::size_t different = 0;
    for (std::size_t i = 0; i < places.size(); ++i) different += (in_a[i] < 0) != (in_b[i] < 0) ? 1 : 0;
    shares[p] = places.empty() ? 0 : static_cast<double>(different) / static_cast<double>(places.size());
  });
  Disagreement result;
  constexpr double k_wrong = 0.1;
  for (const double share : shares) {
    result.share += share / static_cast<double>(primitives.size());
    result.primitives += share >= k_wrong ? 1 : 0;
  }
  return result;
}

}  // namespace cloud2csg
