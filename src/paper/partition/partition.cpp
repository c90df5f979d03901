#include "paper/partition/partition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cloud2csg/error.hpp"
#include "core/base/stopwatch.hpp"
#include "paper/partition/regions.hpp"

namespace cloud2csg {
namespace {

/// The oriented bounds of the points on each unbounded primitive, in its own frame: what of it matters for overlap.
std::vector<std::optional<OrientedBox>> extents_of_unbounded(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                             const SegmentationTolerances& tolerances,
                                                             const RunContext& run) {
  std::vector<std::optional<OrientedBox>> extents(primitives.size());
  for (std::size_t p = 0; p < extents.size(); ++p) {
    const Primitive& primitive = primitives[p];
    if (!std::holds_alternative<HalfSpace>(primitive.shape)) continue;
    const Segmentation segmentation = segment_points(cloud, {primitive}, tolerances, run);
    AlignedBox local;
    for (const std::uint32_t point : segmentation.points_of.front()) {
      local.extend(primitive.pose.to_local(cloud.positions[point]));
    }
    if (local.isEmpty()) continue;
    extents[p] =
        OrientedBox{.pose = compose(primitive.pose, {.position = local.center()}), .half_size = local.sizes() / 2};
  }
  return extents;
}

void build_partitions(const PointCloud& cloud, const ExtractOptions& options, const RunContext& run,
                      Preparation& preparation, StageSeconds& seconds) {
  Stopwatch watch;
  preparation.graph = overlap_graph_of(cloud, preparation.primitives, preparation.scale, options, run);
  seconds.overlap += watch.lap();
  preparation.cliques = maximal_cliques(preparation.graph);
  preparation.components = connected_components(preparation.graph);
  preparation.partitions.clear();
  preparation.component_of.clear();
  if (options.strategy == Strategy::baseline) {
    std::vector<PrimitiveIndex> all(preparation.primitives.size());
    std::iota(all.begin(), all.end(), PrimitiveIndex{0});
    preparation.components = {all};
    preparation.partitions = {all};
    preparation.component_of = {0};
    preparation.partitions_of = {{0}};
    seconds.partition += watch.lap();
    return;
  }
  std::vector<std::size_t> component_of_primitive(preparation.primitives.size());
  for (std::size_t c = 0; c < preparation.components.size(); ++c) {
    for (const PrimitiveIndex p : preparation.components[c]) component_of_primitive[p] = c;
  }
  const auto solved_whole = [&](std::size_t component) {
    return options.strategy == Strategy::automatic &&
           preparation.components[component].size() <= options.search.listing_limit;
  };
  for (std::size_t c = 0; c < preparation.components.size(); ++c) {
    if (!solved_whole(c)) continue;
    preparation.partitions.push_back(preparation.components[c]);
    preparation.component_of.push_back(c);
  }
  for (const Clique& clique : preparation.cliques) {
    const std::size_t component = component_of_primitive[clique.front()];
    if (solved_whole(component)) continue;
    preparation.partitions.push_back(clique);
    preparation.component_of.push_back(component);
  }
  preparation.partitions_of.assign(preparation.components.size(), {});
  for (std::size_t k = 0; k < preparation.partitions.size(); ++k) {
    preparation.partitions_of[preparation.component_of[k]].push_back(k);
  }
  seconds.partition += watch.lap();
}

/// The tables that the search and the merge need.
class Requests {
 public:
  Requests(const PointCloud& cloud, const ExtractOptions& options, const Preparation& preparation)
      : cloud_(cloud), options_(options), preparation_(preparation) {
    for (const Primitive& primitive : preparation.primitives) {
      reach_.push_back(reach(primitive, preparation.scale.tolerances.distance));
    }
  }

  /// One a partition.
  void add_partitions() {
    for (const Clique& partition : preparation_.partitions) {
      add(partition, {}, stride_for(partition.size(), cloud_.size()), surroundings(partition));
    }
  }

  /// For a component of several partitions.
  std::vector<TableWindow> add_windows(const std::vector<PrimitiveIndex>& component) {
    if (component.size() <= k_whole_limit) {
      return {{.table = add(component, {}, stride_for(component.size(), cloud_.size()), {})}};
    }
    std::vector<TableWindow> windows;
    for (PrimitiveIndex local = 0; local < component.size(); ++local) {
      const PrimitiveIndex p = component[local];
      const std::vector<Region> regions = cut_into_regions(preparation_.graph.neighbours[p], reach_, k_whole_limit - 1);
      std::size_t largest = 0;
      for (const Region& region : regions) largest = std::max(largest, region.near.size() + 1);
      // What a primitive scores in its windows is added up: points must weigh the same in all.
      const std::size_t stride = stride_for(largest, cloud_.size());
      for (const Region& region : regions) {
        std::vector<PrimitiveIndex> set = region.near;
        set.insert(std::ranges::upper_bound(set, p), p);
        const auto box = regions.size() == 1 ? std::nullopt : std::optional(region.box);
        windows.push_back({.table = add(std::move(set), {p}, stride, box), .judged = local});
      }
    }
    return windows;
  }

  [[nodiscard]] std::vector<RankClassesRequest> take() && { return std::move(requests_); }

 private:
  /// Overlaps so many others that only those nearby may be looked at.
  [[nodiscard]] bool is_hub(PrimitiveIndex p) const { return preparation_.graph.neighbours[p].size() >= k_whole_limit; }

  std::size_t add(std::vector<PrimitiveIndex> primitives, std::vector<PrimitiveIndex> owners, std::size_t stride,
                  const std::optional<AlignedBox>& region) {
    requests_.push_back({.primitives = std::move(primitives),
                         .owners = std::move(owners),
                         .stride = stride,
                         .without_strangers = options_.without_strangers,
                         .region = region});
    return requests_.size() - 1;
  }

  /// Where a partition with hubs is decided: at its other primitives, and around them. The paper judges by all points.
  [[nodiscard]] std::optional<AlignedBox> surroundings(const Clique& partition) const {
    const bool has_hub = std::ranges::any_of(partition, [&](PrimitiveIndex p) { return is_hub(p); });
    if (!has_hub || !options_.without_strangers || options_.strategy == Strategy::baseline) return std::nullopt;
    AlignedBox box;
    for (const PrimitiveIndex p : partition) {
      if (!is_hub(p)) box.extend(reach_[p]);
    }
    if (box.isEmpty() || !box.sizes().allFinite()) return std::nullopt;
    const Eigen::Vector3d margin = box.sizes() / 2;
    return AlignedBox(box.min() - margin, box.max() + margin);
  }

  const PointCloud& cloud_;
  const ExtractOptions& options_;
  const Preparation& preparation_;
  std::vector<AlignedBox> reach_;  // by primitive
  std::vector<RankClassesRequest> requests_;
};

std::vector<RankClassesRequest> requests_for(const PointCloud& cloud, const ExtractOptions& options,
                                             Preparation& preparation) {
  Requests requests(cloud, options, preparation);
  requests.add_partitions();
  preparation.windows_of.clear();
  for (std::size_t c = 0; c < preparation.components.size(); ++c) {
    const std::vector<std::size_t>& partitions = preparation.partitions_of[c];
    preparation.windows_of.push_back(partitions.size() == 1 ? std::vector<TableWindow>{{.table = partitions.front()}}
                                                            : requests.add_windows(preparation.components[c]));
  }
  return std::move(requests).take();
}

void pass_over_points(const PointCloud& cloud, const ExtractOptions& options, const RunContext& run,
                      Preparation& preparation, StageSeconds& seconds) {
  Stopwatch watch;
  preparation.pass = {};  // of primitives that were dropped: not two of them in memory
  preparation.pass = build_rank_classes(cloud, preparation.primitives, requests_for(cloud, options, preparation),
                                        {.tolerances = preparation.scale.tolerances,
                                         .objective = options.objective,
                                         .noise = preparation.scale.noise,
                                         .precision = options.precision},
                                        run);
  const PointPass& pass = preparation.pass;
  const double wall = watch.lap();
  const double share = pass.segment_seconds / (pass.segment_seconds + pass.classes_seconds);
  seconds.segment += wall * share;
  seconds.classes += wall * (1 - share);
}

/// So many of the primitives that are left out are told by name.
constexpr std::size_t k_named_warnings = 10;

}  // namespace

std::size_t stride_for(std::size_t primitives, std::size_t points) {
  if (primitives <= RankClasses::k_shared_limit) return 1;
  const std::size_t row_bytes = 2 * sizeof(double) * primitives;
  return std::max<std::size_t>(1, points * row_bytes / k_table_bytes);
}

NoiseScale measure_scale(const PointCloud& cloud, const PrimitiveSet& primitives, const ExtractOptions& options,
                         const RunContext& run, ExtractStatistics& statistics) {
  Stopwatch watch;
  const double noise = estimate_noise(cloud, primitives, options.segmentation.angle_tolerance_deg, run);
  statistics.noise = noise;
  statistics.seconds.segment += watch.lap();
  return {.noise = noise, .tolerances = segmentation_tolerances(options.segmentation, noise)};
}

SupportedPrimitives take_all(const PrimitiveSet& primitives) {
  SupportedPrimitives all{primitives, std::vector<PrimitiveIndex>(primitives.size())};
  std::iota(all.original.begin(), all.original.end(), PrimitiveIndex{0});
  return all;
}

bool drop_unsupported(std::span<const std::size_t> points_of_primitive, SupportedPrimitives& supported,
                      std::vector<std::string>& warnings) {
  SupportedPrimitives kept;
  std::size_t dropped = 0;
  for (std::size_t p = 0; p < points_of_primitive.size(); ++p) {
    if (points_of_primitive[p] > 0) {
      kept.primitives.push_back(supported.primitives[p]);
      kept.original.push_back(supported.original[p]);
    } else if (dropped++ < k_named_warnings) {
      warnings.push_back(fmt::format("no point supports primitive '{}': it is left out", supported.primitives[p].id));
    }
  }
  if (dropped > k_named_warnings) {
    warnings.push_back(
        fmt::format("no point supports {} more primitives: they are left out", dropped - k_named_warnings));
  }
  if (kept.primitives.empty()) {
    throw Error({.file = {},
                 .where = {},
                 .expected = "no point of the cloud is near any primitive",
                 .remedy = "check that cloud and primitives are in the same frame and units"});
  }
  supported = std::move(kept);
  return dropped > 0;
}

OverlapGraph overlap_graph_of(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                              const ExtractOptions& options, const RunContext& run) {
  return build_overlap_graph(primitives,
                             {.tolerance = options.overlap_tolerance.value_or(scale.noise),
                              .extents = extents_of_unbounded(cloud, primitives, scale.tolerances, run)},
                             run);
}

Preparation prepare(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                    const ExtractOptions& options, const RunContext& run, ExtractStatistics& statistics) {
  Preparation preparation;
  static_cast<SupportedPrimitives&>(preparation) = take_all(primitives);
  preparation.scale = scale;
  do {
    build_partitions(cloud, options, run, preparation, statistics.seconds);
    pass_over_points(cloud, options, run, preparation, statistics.seconds);
  } while (drop_unsupported(preparation.pass.points_of_primitive, preparation, statistics.warnings));
  statistics.unassigned_points = preparation.pass.unassigned;
  statistics.clique_histogram = clique_histogram(preparation.cliques);
  statistics.components = preparation.components.size();
  return preparation;
}

}  // namespace cloud2csg
