#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "bench/families/family_parts.hpp"
#include "core/geometry/boxes.hpp"
#include "shape/sample/primitive_surface.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

constexpr double k_spacing = 2.4;     ///< between clusters
constexpr double k_bar_reach = 1.32;  ///< half length of a cluster's bar: beyond the midpoint to the next cluster
constexpr double k_core_radius = 0.65;
/// All solids of a cluster contain its centre at this depth, so they overlap.
constexpr double k_least_depth = 0.06;
/// Test points on a primitive's surface that measure its visible share: the bits of a word.
constexpr std::size_t k_probes = 64;
constexpr int k_least_visible = 5;

/// A random solid of the core, in the cluster's frame.
Primitive draw_solid(RandomStream& random) {
  Primitive solid{.id = {}, .shape = Sphere{}};
  solid.pose.orientation = random_orientation(random);
  const auto shift = [&random](double reach) {
    return Vector3d(random_orientation(random) * Vector3d::UnitX() * random.uniform(0, reach));
  };
  switch (random.below(9)) {
    case 0:
    case 1:
      solid.shape = Sphere{.radius = random.uniform(0.15, 0.42)};
      solid.pose.position = shift(0.35);
      break;
    case 2:
    case 3:
    case 4:
      solid.shape = Box{.size = random_between(Vector3d::Constant(0.2), Vector3d::Constant(1.0), random)};
      solid.pose.position = shift(0.3);
      break;
    case 5:
    case 6:
      solid.shape = Cylinder{.radius = random.uniform(0.1, 0.4), .height = random.uniform(0.25, 1.2)};
      solid.pose.position = shift(0.3);
      break;
    case 7:
      solid.shape = Cone{.radius_bottom = random.uniform(0.2, 0.5),
                         .radius_top = random.uniform(0.0, 0.2),
                         .height = random.uniform(0.4, 1.1)};
      solid.pose.position = shift(0.25);
      break;
    default: {
      const Torus torus{.major_radius = random.uniform(0.2, 0.24), .minor_radius = random.uniform(0.09, 0.15)};
      solid.shape = torus;
      solid.pose.position = solid.pose.orientation * Vector3d(torus.major_radius, 0, 0);
      break;
    }
  }
  return solid;
}

double depth_of_middle(const Primitive& solid) {
  Points middle(1);
  return -signed_distance(solid, middle).front();
}

bool is_in_core(const Primitive& solid) {
  const OrientedBox box = oriented_bounds(solid);
  double reach = box.half_size.norm();
  if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) reach = sphere->radius;
  if (const auto* cylinder = std::get_if<Cylinder>(&solid.shape)) {
    reach = std::hypot(cylinder->radius, 0.5 * cylinder->height);
  }
  if (const auto* torus = std::get_if<Torus>(&solid.shape)) reach = torus->major_radius + torus->minor_radius;
  return reach + solid.pose.position.norm() <= k_core_radius;
}

Primitive core_solid(RandomStream& random) {
  for (;;) {
    Primitive solid = draw_solid(random);
    if (is_in_core(solid) && depth_of_middle(solid) >= k_least_depth) return solid;
  }
}

/// A bar along local x through the centre.
Primitive bar(RandomStream& random) {
  Primitive solid{.id = {}, .shape = Sphere{}};
  const double width = random.uniform(0.13, 0.25);
  const double height = random.uniform(0.13, 0.25);
  const double length = 2 * k_bar_reach;
  solid.pose.orientation = random_tilt(2, random);
  const std::uint32_t kind = random.below(3);
  if (kind == 0) {
    solid.shape = Box{.size = {length, 2 * width, 2 * height}};
  } else {
    const Vector3d axis = random.chance(0.5) ? Vector3d::UnitX() : Vector3d(-Vector3d::UnitX());
    solid.pose.orientation = solid.pose.orientation * Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), axis);
    if (kind == 1) solid.shape = Cylinder{.radius = width, .height = length};
    if (kind == 2) solid.shape = Cone{.radius_bottom = width, .radius_top = height, .height = length};
  }
  solid.pose.position = random_shift(0.04, random);
  return solid;
}

/// Bit masks of which primitive contains the points just inside and outside of another's surface.
class Probes {
 public:
  Probes(const PrimitiveSet& primitives, RandomStream& random) : count_(primitives.size()) {
    for (const Primitive& primitive : primitives) {
      const PrimitiveSurface surface = make_surface(primitive, bounds(primitive), {});
      Points points(2 * k_probes);
      for (std::size_t i = 0; i < k_probes; ++i) {
        constexpr double k_off_surface = 1e-6;
        const SurfacePoint point = surface.draw(random);
        points.set(i, point.position - k_off_surface * point.normal);
        points.set(k_probes + i, point.position + k_off_surface * point.normal);
      }
      for (const Primitive& other : primitives) {
        const std::vector<double> distances = signed_distance(other, points);
        within_.push_back(signs(std::span(distances).first(k_probes)));
        without_.push_back(signs(std::span(distances).last(k_probes)));
      }
    }
  }

  /// Number of primitives with enough of their surface on the tree's surface.
  [[nodiscard]] std::size_t visible(const CsgTree& tree) const {
    std::size_t sum = 0;
    for (std::size_t p = 0; p < count_; ++p) sum += is_visible(tree, p) ? 1 : 0;
    return sum;
  }

  [[nodiscard]] bool is_visible(const CsgTree& tree, std::size_t p) const {
    const std::uint64_t changes = value(tree, std::span(within_).subspan(p * count_, count_)) ^
                                  value(tree, std::span(without_).subspan(p * count_, count_));
    return std::popcount(changes) >= k_least_visible;
  }

 private:
  static std::uint64_t signs(std::span<const double> distances) {
    std::uint64_t word = 0;
    for (const double distance : distances) word = (word << 1U) | (distance < 0 ? 1U : 0U);
    return word;
  }

  static std::uint64_t value(const CsgTree& tree, std::span<const std::uint64_t> leaves) {
    std::vector<std::uint64_t> stack;
    for (const CsgNode node : tree.nodes()) {
      if (node.is_leaf()) {
        stack.push_back(leaves[node.primitive()]);
        continue;
      }
      const std::uint64_t second = stack.back();
      stack.pop_back();
      std::uint64_t& first = stack.back();
      first = node.operation() == Operation::union_of       ? first | second
              : node.operation() == Operation::intersection ? first & second
                                                            : first & ~second;
    }
    return stack.back();
  }

  std::size_t count_;
  std::vector<std::uint64_t> within_, without_;  ///< by primitive of the points, then by other primitive
};

Operation random_operation(bool may_intersect, RandomStream& random) {
  const double draw = random.uniform();
  if (may_intersect && draw < 0.25) return Operation::intersection;
  return draw < 0.6 ? Operation::difference : Operation::union_of;
}

/// Appends a tree over primitives first .. first + count - 1 in order. Only unions and first operands of differences
/// lead to the first primitive, so space inside it alone is in the solid.
void append_random_tree(std::vector<CsgNode>& nodes, std::size_t first, std::size_t count, RandomStream& random) {
  if (count == 1) {
    nodes.push_back(CsgNode::leaf(static_cast<PrimitiveIndex>(first)));
    return;
  }
  const std::size_t begin = nodes.size();
  const std::size_t left = 1 + random.below(count - 1);
  append_random_tree(nodes, first, left, random);
  append_random_tree(nodes, first + left, count - left, random);
  const auto length = static_cast<std::uint32_t>(nodes.size() + 1 - begin);
  nodes.push_back(CsgNode::inner(random_operation(/*may_intersect=*/first > 0, random), length));
}

/// Improves the operations of a random tree while more primitives become visible; empty when some stay hidden.
CsgTree find_tree(std::size_t count, const Probes& probes, RandomStream& random) {
  std::vector<CsgNode> nodes;
  append_random_tree(nodes, 0, count, random);
  CsgTree tree(nodes);
  std::size_t visible = probes.visible(tree);
  const std::size_t most_changes = 16 * count;
  for (std::size_t change = 0; visible < count; ++change) {
    if (change == most_changes) return CsgTree::empty();
    const std::size_t at = random.below(nodes.size());
    const CsgNode before = nodes[at];
    if (before.is_leaf()) continue;
    const bool holds_first = at + 1 == before.length();
    nodes[at] = CsgNode::inner(random_operation(!holds_first, random), before.length());
    const CsgTree changed(nodes);
    const std::size_t visible_now = probes.visible(changed);
    if (visible_now < visible) {
      nodes[at] = before;
    } else {
      visible = visible_now;
      tree = changed;
    }
  }
  return tree;
}

struct Cluster {
  PrimitiveSet primitives;
  CsgTree tree;
};

/// A cluster in its own frame, of mutually overlapping and visible primitives.
Cluster random_cluster(std::size_t count, RandomStream& random) {
  for (;;) {
    Cluster cluster;
    cluster.primitives.push_back(bar(random));
    while (cluster.primitives.size() < count) cluster.primitives.push_back(core_solid(random));
    const Probes probes(cluster.primitives, random);
    constexpr int k_trees = 16;
    for (int tree = 0; tree < k_trees; ++tree) {
      cluster.tree = find_tree(count, probes, random);
      if (!primitives_of(cluster.tree).empty()) return cluster;
    }
  }
}

}  // namespace

void build_clusters(FamilyBuilder& builder, const FamilyOptions& options) {
  SpiralPath path(k_spacing, 2.2);
  const std::size_t most = options.clique_size;
  const std::size_t least = options.least_clique_size == 0 ? most : options.least_clique_size;
  for (std::size_t part = 0; builder.size() < options.primitives; ++part) {
    RandomStream random = family_stream(Family::random, options, part);
    const std::size_t wanted = least + random.below(most + 1 - least);
    const Cluster cluster = random_cluster(std::min(wanted, options.primitives - builder.size()), random);
    const Pose place = path.next();
    std::vector<PrimitiveIndex> indices;
    for (const Primitive& primitive : cluster.primitives) {
      indices.push_back(static_cast<PrimitiveIndex>(builder.size()));
      (void)builder.add(primitive.shape, compose(place, primitive.pose));
    }
    builder.add_part(renumber(cluster.tree, indices));
  }
}

}  // namespace cloud2csg
