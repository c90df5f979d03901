#include <algorithm>
#include <cassert>

#include "core/base/parallel.hpp"
#include "core/base/run.hpp"
#include "core/fields/point_blocks.hpp"
#include "core/geometry/spatial_order.hpp"
#include "paper/objective/point_worker.hpp"
#include "paper/objective/rank_classes.hpp"

namespace cloud2csg {
namespace {

/// From this many primitives on, a block of neighbours is near few of them, and finding those pays.
constexpr std::size_t k_many_primitives = 32;

bool is_single_enough(const AlignedBox& box, const PrimitiveSet& primitives, const PointPassOptions& options) {
  if (options.precision != Precision::automatic) return options.precision == Precision::single;
  // On the far side an angle near 180 degrees counts as it is, not squared. A cosine in single cannot resolve it.
  return !far_side_counts(options.objective.gamma) && is_single_enough(box, primitives, options.noise);
}

/// Boxes in which points may belong to each primitive, with room for rounding.
std::vector<AlignedBox> reach_of(const PrimitiveSet& primitives, const AlignedBox& box, double distance) {
  const double largest = (box.isEmpty() ? 0.0 : box.diagonal().norm()) + box.center().norm();
  const double room = 0.01 * distance + 1e-9 * largest;
  std::vector<AlignedBox> boxes;
  for (const Primitive& primitive : primitives) boxes.push_back(reach(primitive, distance + room));
  return boxes;
}

template <class Real>
void link_roots(WorkerInput<Real>& input) {
  input.roots_of.resize(input.primitives.size());
  for (std::uint32_t k = 0; k < input.roots.size(); ++k) {
    if (input.roots[k].all_points) {
      input.roots_of_all_points.push_back(k);
    } else {
      for (const PrimitiveIndex p : input.roots[k].owners) input.roots_of[p].push_back(k);
    }
  }
}

template <class Real>
WorkerInput<Real> input_of(const PointCloud& cloud, const AlignedBox& box, const PrimitiveSet& primitives,
                           std::span<const RankClassesRequest> requests, const PointPassOptions& options,
                           const RunContext& run) {
  const Objective scale = resolve(options.objective, cloud.size(), options.noise);
  WorkerInput<Real> input{.primitives = primitives,
                          .parameters = {},
                          .cloud = cloud,
                          .box = box,
                          .order = spatial_order(cloud.positions, box, run),
                          .roots = plan_roots(requests)};
  for (Root& root : input.roots) {
    if (root.region) root.region->translate(-PointBlocks<Real>::origin(box));
  }
  link_roots(input);
  move_to_frame<Real>(input.primitives, PointBlocks<Real>::origin(box));
  for (const Primitive& primitive : input.primitives) {
    input.parameters.push_back({scale.beta, scale.gamma, options.tolerances, is_plain(primitive)});
  }
  if (primitives.size() > k_many_primitives) {
    input.reach = reach_of(input.primitives, box, options.tolerances.distance);
  }
  return input;
}

/// As many shares as threads, since each costs a set of tables. The result does not depend on their number.
template <class Real>
WorkerShare work(const WorkerInput<Real>& input, const RunContext& run) {
  const std::size_t chunks = chunk_count(input.cloud.size());
  const std::size_t parts = std::clamp<std::size_t>(chunks, 1, static_cast<std::size_t>(usable_threads(run)));
  if (parts == 1) return work_on_chunks(input, 0, chunks, run);
  std::vector<WorkerShare> shares(parts);
  for_each_index(parts, run, [&](std::size_t k) {
    shares[k] = work_on_chunks(input, chunks * k / parts, chunks * (k + 1) / parts, run);
  });
  WorkerShare& sum = shares.front();
  for (std::size_t k = 1; k < parts; ++k) sum.absorb_counts(shares[k]);
  for_each_index(sum.tables.size(), run, [&](std::size_t r) {
    for (std::size_t k = 1; k < parts; ++k) sum.tables[r].absorb(shares[k].tables[r]);
  });
  return std::move(sum);
}

std::vector<RankClasses> build_tables(std::span<const RankClassesRequest> requests, std::span<const Root> roots,
                                      std::span<const ClassTable> classes, const PointPassOptions& options,
                                      const RunContext& run) {
  std::vector<RankClasses> tables(requests.size());
  const auto build = [&](std::size_t k, const ClassTable& grouped) {
    const std::vector<PrimitiveIndex>& primitives = requests[k].primitives;
    tables[k] = RankClassesBuilder::build(primitives, grouped,
                                          resolve(options.objective, grouped.point_count(), options.noise));
  };
  for_each_index(roots.size(), run, [&](std::size_t r) {
    const std::vector<std::size_t>& answered = roots[r].requests;
    if (answered.size() == 1) {
      build(answered.front(), classes[r]);
      return;
    }
    const std::vector<std::uint32_t> inside = inside_words(roots[r], classes[r]);
    for_each_index_in_arena(answered.size(), run, [&](std::size_t i) {
      const std::size_t k = answered[i];
      build(k, project(roots[r], classes[r], inside, requests[k]));
    });
  });
  return tables;
}

template <class Real>
PointPass pass_over(const PointCloud& cloud, const AlignedBox& box, const PrimitiveSet& primitives,
                    std::span<const RankClassesRequest> requests, const PointPassOptions& options,
                    const RunContext& run) {
  Stopwatch watch;
  WorkerInput<Real> input = input_of<Real>(cloud, box, primitives, requests, options, run);
  const WorkerShare share = work(input, run);
  watch.lap();
  PointPass pass{.tables = build_tables(requests, input.roots, share.tables, options, run),
                 .points_of_primitive = share.points_of_primitive,
                 .unassigned = share.unassigned,
                 .order = std::move(input.order),
                 .segment_seconds = share.segment_seconds,
                 .classes_seconds = share.classes_seconds};
  pass.classes_seconds += watch.lap();
  return pass;
}

}  // namespace

PointPass build_rank_classes(const PointCloud& cloud, const PrimitiveSet& primitives,
                             std::span<const RankClassesRequest> requests, const PointPassOptions& options,
                             const RunContext& run) {
  assert(cloud.has_normals() && cloud.size() > 0);
  const AlignedBox box = bounds_of(cloud.positions);
  return is_single_enough(box, primitives, options) ? pass_over<float>(cloud, box, primitives, requests, options, run)
                                                    : pass_over<double>(cloud, box, primitives, requests, options, run);
}

}  // namespace cloud2csg
