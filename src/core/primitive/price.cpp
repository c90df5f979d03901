#include "core/primitive/price.hpp"

#include "core/primitive/profile.hpp"

namespace cloud2csg {
namespace {

/// The price of what a solid has beyond a box: four sides and two ends.
double price_beyond(std::size_t count, std::size_t free, double price) {
  return count > free ? price * static_cast<double>(count - free) : 0.0;
}

}  // namespace

double price_of_segments(std::size_t segments) {
  return price_beyond(segments, 4, k_segment_price);
}

double price_of_planes(std::size_t planes) {
  constexpr double k_plane_price = 0.2;  // a plane has one number more than a corner
  return price_beyond(planes, 6, k_plane_price);
}

double price_of(const Primitive& primitive) {
  if (const Profile* const profile = profile_of(primitive.shape))
    return 1 + price_of_segments(count_segments(*profile));
  if (const auto* polytope = std::get_if<Polytope>(&primitive.shape)) {
    return 1 + price_of_planes(polytope->planes.size());
  }
  return 1;
}

}  // namespace cloud2csg
