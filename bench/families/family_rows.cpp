#include <algorithm>
#include <cmath>

#include "bench/families/family_parts.hpp"

/// Families without rejection: by construction, each primitive is visible and has the intended overlaps.
namespace cloud2csg {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double k_tilt_deg = 6;

/// Turns local z into local x.
Quaterniond lying() {
  return Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::UnitX());
}

struct Placed {
  Shape shape;
  Quaterniond orientation = Quaterniond::Identity();
};

/// A link of the chain: half_length along local x, less than 0.9 across.
Placed random_link(std::size_t kind, double half_length, RandomStream& random) {
  const double width = random.uniform(0.35, 0.6);
  switch (kind % 4) {
    case 0:
      return {.shape = Sphere{.radius = half_length}};
    case 1: {
      const double height = random.uniform(0.35, 0.6);
      return {.shape = Box{.size = 2 * Vector3d(half_length, width, height)}};
    }
    case 2:
      if (random.chance(0.5)) return {.shape = Cylinder{.radius = half_length, .height = 2 * width}};
      return {.shape = Cylinder{.radius = width, .height = 2 * half_length}, .orientation = lying()};
    default:
      return {
          .shape =
              Cone{.radius_bottom = width, .radius_top = width * random.uniform(0.5, 0.8), .height = 2 * half_length},
          .orientation = lying()};
  }
}

/// The outermost box of a nest minus the nested others. `place` is the nest's centre.
CsgTree add_nest(FamilyBuilder& builder, const Pose& place, std::size_t levels, const FamilyOptions& options,
                 RandomStream& random) {
  const Vector3d outermost{1.28, random.uniform(1.0, 1.2), random.uniform(0.9, 1.1)};
  std::vector<CsgTree> boxes;
  for (std::size_t level = 0; level < levels; ++level) {
    // All walls have the same thickness, up to the tilt.
    const double share = 1 - static_cast<double>(level) / static_cast<double>(options.levels + 1);
    const double wall = 1.0 / static_cast<double>(options.levels + 1);
    Vector3d half = share * outermost;
    if (level > 0) half.x() -= 0.2 * share;  // room for the end of the next nest's box
    Pose pose = place;
    pose.position += place.orientation * random_shift(0.1 * wall, random);
    pose.orientation = place.orientation * random_tilt(10 * wall, random);
    boxes.push_back(builder.add(Box{.size = 2 * half}, pose));
  }
  CsgTree tree = boxes.back();
  for (std::size_t level = levels - 1; level-- > 0;) tree = subtract(boxes[level], tree);
  return tree;
}

}  // namespace

void build_chain(FamilyBuilder& builder, const FamilyOptions& options) {
  SpiralPath path(1.0, 2.5);
  CsgTree first;
  for (std::size_t i = 0; i < options.primitives; ++i) {
    RandomStream random = family_stream(Family::chain, options, i);
    // Above half the spacing, so that neighbours overlap widely; below the spacing, so that others do not.
    const double half_length = random.uniform(0.66, 0.8);
    const Placed link = random_link(i, half_length, random);
    Pose pose = path.next();
    pose.position += random_shift(0.03, random);
    pose.orientation = pose.orientation * random_tilt(k_tilt_deg, random) * link.orientation;
    const CsgTree leaf = builder.add(link.shape, pose);
    if (i % 2 == 0) {
      first = leaf;
      if (i + 1 == options.primitives) builder.add_part(leaf);
    } else {
      builder.add_part(random.chance(0.5) ? unite(first, leaf) : subtract(first, leaf));
    }
  }
}

void build_grid(FamilyBuilder& builder, const FamilyOptions& options) {
  // M2: radius 0.25, spacing 0.3, 5 x 4. Displaced slightly, so that no four spheres meet in a point.
  constexpr double k_radius = 0.25;
  constexpr double k_pitch = 0.3;
  constexpr double k_displacement = 0.008;
  const auto columns = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(options.primitives))));
  for (std::size_t i = 0; i < options.primitives; ++i) {
    RandomStream random = family_stream(Family::grid, options, i);
    const std::size_t row = i / columns;
    const Vector3d place(k_pitch * static_cast<double>(i % columns), k_pitch * static_cast<double>(row), 0);
    builder.add_part(builder.add(Sphere{.radius = k_radius + random.uniform(-k_displacement, k_displacement)},
                                 {.position = place + random_shift(k_displacement, random)}));
  }
}

void build_nests(FamilyBuilder& builder, const FamilyOptions& options) {
  SpiralPath path(2.4, 3.6);
  for (std::size_t nest = 0; builder.size() < options.primitives; ++nest) {
    RandomStream random = family_stream(Family::nest, options, nest);
    const std::size_t levels = std::min(options.levels, options.primitives - builder.size());
    builder.add_part(add_nest(builder, path.next(), levels, options, random));
  }
}

}  // namespace cloud2csg
