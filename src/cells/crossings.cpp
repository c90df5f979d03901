#include "cells/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "cells/side_kernels.hpp"
#include "core/base/parallel.hpp"
#include "core/fields/point_blocks.hpp"
#include "core/geometry/subset.hpp"

namespace cloud2csg {
namespace {

/// What to count: points on surfaces, or the lines of sight that places are on.
enum class Counted : std::uint8_t { points, lines };

template <class Real>
struct Input {
  Counted counted;
  const PointCloud& cloud;
  std::span<const std::uint32_t> order;
  AlignedBox box;
  PrimitiveSet primitives;        // in the frame of the blocks
  std::vector<AlignedBox> reach;  // by primitive: where points may be on it, in the frame of the blocks
  SegmentationTolerances tolerances;
};

/// A primitive whose surface may be in a block.
template <class Real>
struct ActivePrimitive {
  BlockField<Real> field;
  BlockSides sides;
  PrimitiveIndex primitive = 0;
};

template <class Real>
class CrossingCounter {
 public:
  explicit CrossingCounter(const Input<Real>& input) : input_(input), blocks_(input.cloud, input.box, input.order) {
    crossings_.points_of_primitive.resize(input.primitives.size());
  }

  void process(std::size_t chunk) {
    blocks_.load(chunk);
    look_around();
    for (std::size_t block = 0; block < blocks_.count(); ++block) {
      find_active(block);
      if (input_.counted == Counted::points) tally(blocks_.size(block));
      if (input_.counted == Counted::lines) tally_places(blocks_.size(block));
    }
  }

  [[nodiscard]] Crossings& crossings() { return crossings_; }

 private:
  /// A primitive's distances at the middle of each block of the chunk.
  struct NearPrimitive {
    PrimitiveIndex primitive = 0;
    std::vector<double> at_middle;  // empty where they say nothing of the rest of the block
  };

  void look_around() {
    boxes_.clear();
    Points middles;
    for (std::size_t block = 0; block < blocks_.count(); ++block) {
      boxes_.push_back(blocks_.bounds(block));
      middles.push_back(boxes_.back().center());
    }
    AlignedBox box;
    for (const AlignedBox& of_block : boxes_) box.extend(of_block);
    near_.clear();
    for (PrimitiveIndex p = 0; p < input_.primitives.size(); ++p) {
      if (!input_.reach[p].intersects(box)) continue;
      NearPrimitive& near = near_.emplace_back();
      near.primitive = p;
      // The distance at one point can rule out a block only where its Lipschitz constant is 1.
      if (!is_plain(input_.primitives[p])) continue;
      near.at_middle.resize(middles.size());
      evaluate_distance(input_.primitives[p], middles, near.at_middle);
    }
  }

  /// Finds the primitives whose surface may be in the block, and those that hold all of it.
  void find_active(std::size_t block) {
    active_count_ = 0;
    around_.clear();
    const double radius = boxes_[block].diagonal().norm() / 2;
    const double margin = 1.001 * (radius + input_.tolerances.distance);
    for (const NearPrimitive& near : near_) {
      if (!input_.reach[near.primitive].intersects(boxes_[block])) continue;
      if (!near.at_middle.empty() && std::abs(near.at_middle[block]) > margin) {
        if (near.at_middle[block] < 0) around_.push_back(near.primitive);
        continue;
      }
      look_at(near.primitive, block);
    }
  }

  void look_at(PrimitiveIndex p, std::size_t block) {
    if (active_count_ == actives_.size()) actives_.emplace_back();
    ActivePrimitive<Real>& active = actives_[active_count_++];
    active.primitive = p;
    BlockField<Real>& field = active.field;
    evaluate_field(input_.primitives[p], blocks_.positions(block), spans_of(field));
    compute_sides(field, blocks_.normals(block), input_.tolerances, active.sides);
  }

  [[nodiscard]] std::span<ActivePrimitive<Real>> active() { return std::span(actives_).first(active_count_); }

  /// Keeps points to the nearest surface and those that coincide with it. Of a thin wall they then see one side.
  void keep_to_nearest() {
    BlockMask on_any{};
    BlockMask on_several{};
    for (const ActivePrimitive<Real>& one : active()) {
      const BlockMask on = either(one.sides.along, one.sides.against);
      on_several = either(on_several, both(on_any, on));
      on_any = either(on_any, on);
    }
    if (is_empty(on_several)) return;
    const Real apart = static_cast<Real>(k_open_share * input_.tolerances.distance);
    for (std::size_t i = 0; i < k_block_points; ++i) {
      if (!has_point(on_several, i)) continue;
      Real least = std::numeric_limits<Real>::max();
      for (const ActivePrimitive<Real>& one : active()) {
        if (has_point(one.sides.along, i) || has_point(one.sides.against, i)) {
          least = std::min(least, std::abs(one.field.distance[i]));
        }
      }
      for (ActivePrimitive<Real>& one : active()) {
        if (std::abs(one.field.distance[i]) <= least + apart) continue;
        remove_point(one.sides.along, i);
        remove_point(one.sides.against, i);
      }
    }
  }

  /// Counts the points on some surface for which no active primitive leaves the side open.
  void tally(std::size_t points) {
    const BlockMask all = first_points(points);
    BlockMask on_any{};
    BlockMask open{};
    unsure_ = {};
    for (const ActivePrimitive<Real>& one : active()) {
      crossings_.points_of_primitive[one.primitive] +=
          point_count(both(all, either(one.sides.along, one.sides.against)));
    }
    keep_to_nearest();
    for (const ActivePrimitive<Real>& one : active()) {
      const BlockMask on = both(all, either(one.sides.along, one.sides.against));
      on_any = either(on_any, on);
      open = either(open, without(one.sides.open, on));
      unsure_ = either(unsure_, without(one.sides.near, on));
    }
    crossings_.unassigned += points - point_count(on_any);
    split(0, without(on_any, open));
  }

  /// Counts the lines of a block by the cells that they clearly pass through.
  void tally_places(std::size_t places) {
    BlockMask near{};
    for (const ActivePrimitive<Real>& one : active()) near = either(near, one.sides.near);
    split(0, without(first_points(places), near));
  }

  /// Divides points by their side of one active primitive after the other.
  void split(std::size_t next, const BlockMask& points) {
    if (is_empty(points)) return;
    if (next == active_count_) return add(points);
    const BlockSides& sides = actives_[next].sides;
    const auto follow = [&](Side side, const BlockMask& some) {
      path_.push_back(side);
      split(next + 1, some);
      path_.pop_back();
    };
    follow(Side::along, both(points, sides.along));
    follow(Side::against, both(points, sides.against));
    const BlockMask clear = without(points, either(sides.along, sides.against));
    follow(Side::inside, both(clear, sides.inside));
    follow(Side::outside, without(clear, sides.inside));
  }

  /// Adds points that are all on the sides in path_.
  void add(const BlockMask& points) {
    inner_ = around_;
    outer_ = around_;
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const PrimitiveIndex p = actives_[i].primitive;
      if (path_[i] == Side::inside || path_[i] == Side::along) inner_.push_back(p);
      if (path_[i] == Side::inside || path_[i] == Side::against) outer_.push_back(p);
    }
    std::ranges::sort(inner_);
    std::ranges::sort(outer_);
    const CellIndex inner = crossings_.cells.find_or_insert(inner_);
    const CellIndex outer = crossings_.cells.find_or_insert(outer_);
    std::uint64_t& units = crossings_.units[Crossings::pair(inner, outer)];
    if (input_.counted == Counted::lines) {
      units += byte_count(points);
      return;
    }
    const std::uint64_t unsure = point_count(both(points, unsure_));
    units += k_sure_units * (point_count(points) - unsure) + unsure;
  }

  enum class Side : std::uint8_t { inside, outside, along, against };

  const Input<Real>& input_;
  PointBlocks<Real> blocks_;
  std::vector<AlignedBox> boxes_;  // by block of the chunk
  std::vector<NearPrimitive> near_;
  std::vector<ActivePrimitive<Real>> actives_;  // the first active_count_ are in use
  std::size_t active_count_ = 0;
  Cell around_;  // primitives that hold all of the block
  BlockMask unsure_{};
  std::vector<Side> path_;
  Cell inner_, outer_;
  Crossings crossings_;
};

/// One share of the chunks for each thread.
template <class Real>
std::vector<Crossings> count_in(Counted counted, const PointCloud& cloud, std::span<const std::uint32_t> order,
                                const AlignedBox& box, const ReachingPrimitives& reaching,
                                const SegmentationTolerances& tolerances, const RunContext& run) {
  Input<Real> input{counted, cloud, order, box, reaching.primitives, reaching.reach, tolerances};
  const Eigen::Vector3d origin = PointBlocks<Real>::origin(box);
  move_to_frame<Real>(input.primitives, origin);
  for (AlignedBox& reached : input.reach) reached.translate(-origin);
  const std::size_t chunks = chunk_count(cloud.size());
  const std::size_t parts = std::clamp<std::size_t>(chunks, 1, static_cast<std::size_t>(usable_threads(run)));
  std::vector<Crossings> shares(parts);
  for_each_index(parts, run, [&](std::size_t k) {
    CrossingCounter<Real> counter(input);
    for (std::size_t chunk = chunks * k / parts; chunk < chunks * (k + 1) / parts; ++chunk) {
      run.throw_if_stopped();
      // The first share stands for all: they have one size and advance together.
      if (k == 0) run.report("segment", cloud.size() * chunk / (chunks / parts), cloud.size(), "points");
      counter.process(chunk);
    }
    shares[k] = std::move(counter.crossings());
  });
  return shares;
}

std::vector<Crossings> count(Counted counted, const PointCloud& cloud, std::span<const std::uint32_t> order,
                             const ReachingPrimitives& reaching, const SegmentationTolerances& tolerances,
                             const RunContext& run) {
  const AlignedBox box = bounds_of(cloud.positions);
  return reaching.is_single ? count_in<float>(counted, cloud, order, box, reaching, tolerances, run)
                            : count_in<double>(counted, cloud, order, box, reaching, tolerances, run);
}

using Eigen::Vector3d;

std::vector<char> are_near(const Points& points, const ReachingPrimitives& reaching, double tolerance,
                           const RunContext& run) {
  std::vector<std::vector<std::uint32_t>> near(reaching.primitives.size());
  for_each_index(near.size(), run, [&](std::size_t p) {
    Points reached;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (!reaching.reach[p].contains(points[i])) continue;
      reached.push_back(points[i]);
      near[p].push_back(i);
    }
    const std::vector<double> distances = signed_distance(reaching.primitives[p], reached);
    std::size_t k = 0;
    std::erase_if(near[p], [&](std::uint32_t) { return std::abs(distances[k++]) > tolerance; });
  });
  std::vector<char> is_near(points.size(), 0);
  for (const std::vector<std::uint32_t>& of_primitive : near) {
    for (const std::uint32_t i : of_primitive) is_near[i] = 1;
  }
  return is_near;
}

/// The share of the way from a to b that is before the box.
double share_before(const AlignedBox& box, const Vector3d& a, const Vector3d& b) {
  double entry = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = b[axis] - a[axis];
    if (way == 0) continue;
    entry = std::max(entry, ((way > 0 ? box.min() : box.max())[axis] - a[axis]) / way);
  }
  return std::min(entry, 1.0);
}

void add_places(const AlignedBox& box, const Vector3d& sensor, const Vector3d& point, PointCloud& places) {
  const double first = share_before(box, sensor, point);
  for (std::size_t k = 0; k < k_places_a_line; ++k) {
    const double along = first + (1 - first) * (static_cast<double>(k) + 0.5) / k_places_a_line;
    places.positions.push_back(sensor + along * (point - sensor));
    places.normals.push_back(Vector3d::Zero());  // a place is on no surface
  }
}

}  // namespace

CellIndex CellSet::find_or_insert(const Cell& cell) {
  const auto [place, is_new] = index_.try_emplace(cell, static_cast<CellIndex>(cells_.size()));
  if (is_new) cells_.push_back(&place->first);
  return place->second;
}

ReachingPrimitives reaching_primitives(const PrimitiveSet& primitives, const AlignedBox& points,
                                       const CellOptions& options) {
  // Room for rounding.
  const double distance =
      1.01 * options.tolerances.distance + 1e-9 * (points.diagonal().norm() + points.center().norm());
  std::vector<AlignedBox> boxes;
  boxes.reserve(primitives.size());
  for (const Primitive& primitive : primitives) boxes.push_back(reach(primitive, distance));
  const bool is_single = options.precision == Precision::automatic ? is_single_enough(points, primitives, options.noise)
                                                                   : options.precision == Precision::single;
  return {.primitives = primitives, .reach = std::move(boxes), .is_single = is_single};
}

std::vector<Crossings> count_crossings(const PointCloud& cloud, std::span<const std::uint32_t> order,
                                       const ReachingPrimitives& reaching, const SegmentationTolerances& tolerances,
                                       const RunContext& run) {
  return count(Counted::points, cloud, order, reaching, tolerances, run);
}

std::vector<Crossings> count_lines(const SightLines& lines, const ReachingPrimitives& reaching,
                                   const SegmentationTolerances& tolerances, const RunContext& run) {
  std::vector<std::uint32_t> order(lines.places.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  return count(Counted::lines, lines.places, order, reaching, tolerances, run);
}

SightLines find_sight_lines(const PointCloud& cloud, std::span<const std::uint32_t> order,
                            const ReachingPrimitives& reaching, const CellOptions& options, const RunContext& run) {
  SightLines lines;
  if (!cloud.has_sensor_positions()) return lines;
  std::vector<std::uint32_t> seen = some_of(order, options.sight_lines);
  if (seen.empty()) return lines;
  lines.points_each = static_cast<double>(order.size()) / static_cast<double>(seen.size());
  const Points ends = select_points(cloud.positions, seen);
  const std::vector<char> is_near = are_near(ends, reaching, options.tolerances.distance, run);
  std::size_t k = 0;
  std::erase_if(seen, [&](std::uint32_t) { return is_near[k++] == 0; });
  // Lines from one sensor to neighbouring points are near each other all along.
  std::ranges::stable_sort(seen, {}, [&](std::uint32_t i) {
    const Vector3d sensor = cloud.sensor_positions[i];
    return std::tuple(sensor.x(), sensor.y(), sensor.z());
  });
  const AlignedBox box = bounds_of(cloud.positions);
  for (const std::uint32_t i : seen) add_places(box, cloud.sensor_positions[i], cloud.positions[i], lines.places);
  lines.count = seen.size();
  return lines;
}

}  // namespace cloud2csg
