#include "shape/sample/surface_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/fields/onto_surface.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

enum class Stream : std::uint64_t { candidates = 0x73796e7468'01, order = 0x73796e7468'02 };

/// Candidates a job: enough to hide the overhead, few enough to share among threads.
constexpr std::size_t k_job_candidates = 8192;
/// Relative to the solid's diagonal: far above the rounding of coordinates, far below any detail.
constexpr double k_relative_epsilon = 1e-6;
/// Slope limit of a displacement or expression, because the exact test for duplicates divides by the slope.
constexpr double k_steepest = 100.0;

void add(PointCloud& cloud, const Vector3d& position, const Vector3d& normal) {
  cloud.positions.push_back(position);
  cloud.normals.push_back(normal);
}

/// Shuffles, because the points of a batch come sorted by primitive and a part must represent the whole.
void shuffle(PointCloud& cloud, RandomStream random) {
  for (std::size_t i = cloud.size(); i > 1; --i) {
    const std::size_t j = random.below(i);
    for (Points* points : {&cloud.positions, &cloud.normals}) {
      std::swap(points->x[i - 1], points->x[j]);
      std::swap(points->y[i - 1], points->y[j]);
      std::swap(points->z[i - 1], points->z[j]);
    }
  }
}

}  // namespace

void refuse_without_surface() {
  throw Error({.where = "tree", .expected = "the solid is empty: it has no surface"});
}

AlignedBox finite_bounds(const Model& model) {
  const AlignedBox region = bounds_of(model);
  if (region.isEmpty()) refuse_without_surface();
  if (!is_finite(region)) {
    throw Error({.where = "tree",
                 .expected = "the solid is unbounded: its surface cannot be sampled",
                 .remedy = "intersect it with a bounded primitive such as a box"});
  }
  return region;
}

SurfaceSampler::SurfaceSampler(const Model& model, std::uint64_t seed, const RunContext& run)
    : primitives_(model.primitives), used_(primitives_of(tree_of(model))), seed_(seed) {
  const AlignedBox region = finite_bounds(model);
  epsilon_ = k_relative_epsilon * region.diagonal().norm();
  for (const PrimitiveIndex p : used_) {
    surfaces_.push_back(make_surface(primitives_[p], region, run));
    area_ += surfaces_.back().area;
    cumulative_area_.push_back(area_);
  }
  if (!(area_ > 0.0)) refuse_without_surface();
  neighbourhoods_ = neighbourhoods(model, used_, k_steepest * epsilon_);
}

std::vector<PointCloud> SurfaceSampler::batches(std::size_t first, std::size_t count, const RunContext& run) const {
  std::vector<Candidates> drawn(count);
  for_each_index(count, run, [&](std::size_t i) { drawn[i] = draw(first + i); });
  std::vector<std::vector<Verdict>> verdicts(count);
  for (std::size_t i = 0; i < count; ++i) verdicts[i].resize(drawn[i].points.size());
  const Plan todo = plan(drawn);
  for_each_index(todo.jobs.size(), run, [&](std::size_t j) {
    const Job& job = todo.jobs[j];
    const std::span<const Range> ranges = std::span(todo.ranges).subspan(job.first, job.last - job.first);
    PointCloud candidates;
    for (const Range& range : ranges) {
      const PointCloud& points = drawn[range.batch].points;
      for (std::size_t i = range.begin; i < range.end; ++i) add(candidates, points.positions[i], points.normals[i]);
    }
    const std::vector<Verdict> judged = judge(candidates, job.surface);
    auto next = judged.begin();
    for (const Range& range : ranges) {
      const auto length = static_cast<std::ptrdiff_t>(range.end - range.begin);
      std::copy_n(next, length, verdicts[range.batch].begin() + static_cast<std::ptrdiff_t>(range.begin));
      next += length;
    }
  });
  std::vector<PointCloud> result(count);
  for_each_index(count, run, [&](std::size_t i) { result[i] = visible(drawn[i], verdicts[i], first + i); });
  return result;
}

SurfaceSampler::Candidates SurfaceSampler::draw(std::size_t batch) const {
  RandomStream random(seed_, static_cast<std::uint64_t>(Stream::candidates), batch);
  std::vector<SurfacePoint> points;
  std::vector<std::uint32_t> surface;
  for (std::size_t i = 0; i < k_batch_candidates; ++i) {
    const auto found = std::ranges::upper_bound(cumulative_area_, random.uniform() * area_);
    const auto last = static_cast<std::ptrdiff_t>(used_.size()) - 1;
    const auto chosen = static_cast<std::size_t>(std::min(found - cumulative_area_.begin(), last));
    if (surfaces_[chosen].area == 0.0) continue;
    points.push_back(surfaces_[chosen].draw(random));
    surface.push_back(static_cast<std::uint32_t>(chosen));
  }
  return sorted_by_surface(points, surface);
}

/// Sorts stably by surface. Drops points that do not settle on their surface.
SurfaceSampler::Candidates SurfaceSampler::sorted_by_surface(const std::vector<SurfacePoint>& points,
                                                             const std::vector<std::uint32_t>& surface) const {
  std::vector<std::size_t> begin(surfaces_.size() + 1, 0);
  for (const std::uint32_t s : surface) ++begin[s + std::size_t{1}];
  for (std::size_t s = 0; s < surfaces_.size(); ++s) begin[s + 1] += begin[s];
  std::vector<std::size_t> order(points.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) order[next[surface[i]]++] = i;
  Candidates candidates;
  for (std::size_t k = 0; k < order.size();) {
    const std::uint32_t s = surface[order[k]];
    PointCloud group;
    for (; k < begin[s + std::size_t{1}]; ++k) add(group, points[order[k]].position, points[order[k]].normal);
    const double reach = surfaces_[s].reach;
    const std::vector<bool> is_good =
        reach > 0 ? move_onto_surface(primitives_[used_[s]], reach, group) : std::vector<bool>(group.size(), true);
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (!is_good[i]) continue;
      add(candidates.points, group.positions[i], group.normals[i]);
      candidates.surface.push_back(s);
    }
  }
  return candidates;
}

/// Brings the candidates of each surface together.
SurfaceSampler::Plan SurfaceSampler::plan(const std::vector<Candidates>& batches) const {
  std::vector<std::vector<Range>> by_surface(surfaces_.size());
  for (std::size_t batch = 0; batch < batches.size(); ++batch) {
    const std::vector<std::uint32_t>& surface = batches[batch].surface;
    for (std::size_t begin = 0, end = 0; begin < surface.size(); begin = end) {
      while (end < surface.size() && surface[end] == surface[begin]) ++end;
      by_surface[surface[begin]].push_back({.batch = batch, .begin = begin, .end = end});
    }
  }
  Plan plan;
  for (std::uint32_t s = 0; s < by_surface.size(); ++s) {
    std::size_t candidates = k_job_candidates;
    for (const Range& range : by_surface[s]) {
      if (candidates >= k_job_candidates) {
        plan.jobs.push_back({.surface = s, .first = plan.ranges.size(), .last = plan.ranges.size()});
        candidates = 0;
      }
      plan.ranges.push_back(range);
      ++plan.jobs.back().last;
      candidates += range.end - range.begin;
    }
  }
  return plan;
}

std::vector<SurfaceSampler::Verdict> SurfaceSampler::judge(const PointCloud& candidates, std::uint32_t surface) const {
  const std::size_t count = candidates.size();
  Points sides(2 * count);  // epsilon outside, then epsilon inside
  for (std::size_t i = 0; i < count; ++i) {
    sides.set(i, candidates.positions[i] + epsilon_ * candidates.normals[i]);
    sides.set(count + i, candidates.positions[i] + -epsilon_ * candidates.normals[i]);
  }
  const Neighbourhood& here = neighbourhoods_[surface];
  const std::vector<double> values = implicit_value(here.tree, here.primitives, sides);
  std::vector<Verdict> verdicts(count, Verdict::hidden);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_inside = values[count + i] < 0.0;
    if ((values[i] < 0.0) == is_inside) continue;
    // The solid is outside a primitive that is cut away.
    verdicts[i] = is_inside ? Verdict::outward : Verdict::inward;
  }
  drop_duplicates(candidates, surface, verdicts);
  return verdicts;
}

/// Where surfaces of several primitives coincide, keeps only the points of the smallest index.
void SurfaceSampler::drop_duplicates(const PointCloud& candidates, std::uint32_t surface,
                                     std::span<Verdict> verdicts) const {
  Points places;
  std::vector<std::size_t> place_of;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (verdicts[i] == Verdict::hidden) continue;
    places.push_back(candidates.positions[i]);
    place_of.push_back(i);
  }
  for (const PrimitiveIndex p : neighbourhoods_[surface].members) {
    if (p >= used_[surface]) break;
    const std::vector<double> distances = signed_distance(primitives_[p], places);
    std::vector<std::size_t> suspects;
    Points suspicious;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      if (std::abs(distances[k]) > k_steepest * epsilon_) continue;
      suspects.push_back(k);
      suspicious.push_back(places[k]);
    }
    const Points gradients = gradient(primitives_[p], suspicious);
    for (std::size_t j = 0; j < suspects.size(); ++j) {
      const std::size_t k = suspects[j];
      const double slope = gradients[j].norm();
      constexpr double k_parallel = 1e-4;  // least sine between different normals
      if (slope > 0.0 && std::abs(distances[k]) <= epsilon_ * slope &&
          gradients[j].cross(candidates.normals[place_of[k]]).norm() <= k_parallel * slope) {
        verdicts[place_of[k]] = Verdict::hidden;
      }
    }
  }
}

PointCloud SurfaceSampler::visible(const Candidates& candidates, std::span<const Verdict> verdicts,
                                   std::size_t batch) const {
  PointCloud cloud;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (verdicts[i] == Verdict::hidden) continue;
    const double side = verdicts[i] == Verdict::outward ? 1.0 : -1.0;
    add(cloud, candidates.points.positions[i], side * candidates.points.normals[i]);
  }
  shuffle(cloud, RandomStream(seed_, static_cast<std::uint64_t>(Stream::order), batch));
  return cloud;
}

}  // namespace cloud2csg
