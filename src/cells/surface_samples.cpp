#include "cells/surface_samples.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.hpp"
#include "core/fields/onto_surface.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/subset.hpp"
#include "core/primitive/bounds_index.hpp"
#include "core/primitive/sampled_field.hpp"
#include "core/primitive/surface_points.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_sample_stream = 0x63656c6c73'00;

/// The points that reach the surface, with their normals.
PointCloud settled(const Primitive& primitive, Points points, double scale) {
  PointCloud near{.positions = std::move(points), .normals = {}};
  near.normals.resize(near.size());
  return select_points(near, places_where(move_onto_surface(primitive, scale, near)));
}

struct Drawn {
  PointCloud points;
  double area_of_one = 0;
};

Drawn draw_plain(const Primitive& primitive, const AlignedBox& region, std::size_t samples, RandomStream& random) {
  const PrimitiveSurface surface = make_plain_surface(primitive, region);
  Drawn drawn{.points = {}, .area_of_one = surface.area / static_cast<double>(samples)};
  if (!(surface.area > 0)) return drawn;
  for (std::size_t i = 0; i < samples; ++i) {
    const SurfacePoint point = surface.draw(random);
    drawn.points.positions.push_back(point.position);
    drawn.points.normals.push_back(point.normal);
  }
  return drawn;
}

/// Places near a surface of which only the field is known.
struct Layer {
  Points points;
  double volume;  ///< estimated
};

/// Draws places until `samples` of them are within `depth` of the surface, for a few rounds at most.
Layer draw_layer(const Primitive& primitive, const AlignedBox& box, double depth, std::size_t samples,
                 RandomStream& random) {
  constexpr std::size_t k_places_a_sample = 16;
  constexpr int k_rounds = 8;
  const std::size_t places = k_places_a_sample * samples;
  Points drawn(places);
  Points near;
  int rounds = 0;
  while (rounds < k_rounds && near.size() < samples) {
    ++rounds;
    for (std::size_t i = 0; i < places; ++i) drawn.set(i, random_between(box.min(), box.max(), random));
    const SampledField field = sample_field(primitive, drawn);
    for (std::size_t i = 0; i < places; ++i) {
      if (std::abs(field.distances[i]) <= depth * field.slopes[i].norm()) near.push_back(drawn[i]);
    }
  }
  const double share = static_cast<double>(near.size()) / (rounds * static_cast<double>(places));
  return {.points = std::move(near), .volume = share * box.volume()};
}

/// Moves places in a thin layer onto a surface of which only the field is known. Chance estimates the layer's volume.
Drawn draw_from_field(const Primitive& primitive, const AlignedBox& box, std::size_t samples, RandomStream& random) {
  constexpr double k_layer = 0.01;  // half its thickness, as a share of the diagonal
  const double scale = box.diagonal().norm();
  Layer layer = draw_layer(primitive, box, k_layer * scale, samples, random);
  layer.points.resize(std::min(layer.points.size(), samples));
  Drawn drawn{.points = settled(primitive, std::move(layer.points), scale)};
  const double area = layer.volume / (2 * k_layer * scale);
  drawn.area_of_one = area / std::max(1.0, static_cast<double>(drawn.points.size()));
  return drawn;
}

/// A box that may be infinite, cut down to a range that the index can hold.
IndexBox finite(const AlignedBox& box, const AlignedBox& region) {
  const AlignedBox all = grown(region, 1e3 * region.diagonal().norm());
  const auto within = [&all](const Eigen::Vector3d& corner) {
    return Eigen::Vector3d(corner.cwiseMax(all.min()).cwiseMin(all.max()));
  };
  return to_index_box(AlignedBox(within(box.min()), within(box.max())), 0);
}

BoundsIndex index_of(std::span<const AlignedBox> boxes, const AlignedBox& region) {
  std::vector<IndexEntry> entries;
  entries.reserve(boxes.size());
  for (PrimitiveIndex p = 0; p < boxes.size(); ++p) entries.emplace_back(finite(boxes[p], region), p);
  return BoundsIndex(entries);
}

std::size_t count_meeting(const BoundsIndex& index, const AlignedBox& box, const AlignedBox& region) {
  namespace bgi = boost::geometry::index;
  return static_cast<std::size_t>(std::distance(index.qbegin(bgi::intersects(finite(box, region))), index.qend()));
}

}  // namespace

SurfaceSamples sample_surfaces(const PrimitiveSet& primitives, std::span<const AlignedBox> boxes,
                               const AlignedBox& region, const SampleCounts& counts, const RunContext& run) {
  const BoundsIndex index = index_of(boxes, region);
  std::vector<Drawn> drawn(primitives.size());
  const auto draw = [&](std::size_t p) {
    const std::size_t neighbours = std::max<std::size_t>(count_meeting(index, boxes[p], region), 1) - 1;
    const std::size_t samples = std::min(counts.base + counts.a_neighbour * neighbours, counts.most);
    RandomStream random(0, k_sample_stream, p);
    // Expressions reach anywhere, and half-spaces have no end.
    const bool is_formula = std::holds_alternative<Expression>(primitives[p].shape);
    const AlignedBox box =
        (is_formula ? bounds(primitives[p]) : boxes[p]).intersection(grown(region, region.diagonal().norm()));
    drawn[p] = is_plain(primitives[p]) ? draw_plain(primitives[p], region, samples, random)
                                       : draw_from_field(primitives[p], box, samples, random);
  };
  for_each_index(primitives.size(), run, draw);
  SurfaceSamples result;
  for (const Drawn& one : drawn) {
    result.area_of_sample.push_back(one.area_of_one);
    append(result.points, one.points);
  }
  return result;
}

}  // namespace cloud2csg
