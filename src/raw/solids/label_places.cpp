#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/boxes.hpp"
#include "core/geometry/neighbour_tree.hpp"
#include "core/geometry/subset.hpp"
#include "raw/solids/lattice_places.hpp"

namespace cloud2csg {
namespace {

constexpr std::uint64_t k_place_stage = 0x706c'6163'65;
constexpr std::size_t k_least_points = 16;
constexpr double k_near_spacings = 1.5;  // to places whose side the nearest points know
constexpr double k_clear_in = 0.7;
constexpr double k_clear_out = 0.3;
constexpr double k_far_margin = 0.3;         // in diagonals, beyond the margin
constexpr std::size_t k_chunk_places = 256;  // places between two looks at the stop token

[[noreturn]] void refuse(const char* where, std::string expected, std::string remedy = {}) {
  throw Error({.where = where, .expected = std::move(expected), .remedy = std::move(remedy)});
}

[[noreturn]] void refuse_without_inside(const PointCloud& cloud) {
  const char* const remedy =
      cloud.has_sensor_positions()
          ? "give points from all sides, or, for the space in a room, leave out the sensor positions"
          : "give points from all sides of the object, and outward normals or sensor positions if there are any";
  throw NoInside({.where = "cloud",
                  .expected = "expected the surface of a solid, found one that encloses nothing",
                  .remedy = remedy});
}

void check(const PointCloud& cloud, const PlaceOptions& options, std::span<const double> areas) {
  if (!cloud.has_normals()) refuse("cloud", "expected a cloud with outward normals");
  if (cloud.size() < k_least_points) refuse("cloud", fmt::format("expected at least {} points", k_least_points));
  if (!areas.empty() && areas.size() != cloud.size()) {
    refuse("areas", fmt::format("expected one for each of {} points, found {}", cloud.size(), areas.size()));
  }
  validate(options);
}

class Labelling {
 public:
  Labelling(const PointCloud& cloud, const PlaceOptions& options, const RunContext& run, std::span<const double> areas)
      : cloud_(cloud), options_(options), run_(run), index_(cloud.positions), areas_(areas.begin(), areas.end()) {
    if (areas_.empty()) areas_ = point_areas(cloud, run);
    const AlignedBox box = bounds_of(cloud.positions);
    diagonal_ = box.diagonal().norm();
    if (!(diagonal_ > 0)) refuse("cloud", "expected points that are not all in one place");
    spacing_ = spacing_of(areas_);
    noise_ = options.noise.value_or(0.1 * spacing_);
    grown_ = grown(box, options.margin * diagonal_);
    if (!(enclosed_volume() > 0)) refuse_without_inside(cloud_);
  }

  void add_volume(LabelledPlaces& places) const {
    const WindingField winding(cloud_.positions, cloud_.normals, areas_);
    LatticePlaces lattice = stratified(grown_, options_.volume_places, RandomStream(options_.seed, k_place_stage, 0));
    const std::vector<bool> is_seen = move_onto_lines(lattice);  // outside, so their winding number is 0
    const Points& candidates = lattice.places;
    std::vector<double> numbers(candidates.size());
    for_each_index_by_chunks(candidates.size(), k_chunk_places, run_,
                             [&](std::size_t i) { numbers[i] = is_seen[i] ? 0 : winding.at(candidates[i]); });
    // All areas share an unknown factor, which places clearly inside determine.
    std::vector<double> inside;
    std::ranges::copy_if(numbers, std::back_inserter(inside), [](double number) { return number > 0.5; });
    if (inside.empty()) refuse_without_inside(cloud_);
    const std::vector<int> sides = sides_of(candidates, numbers, median_of(inside));
    const auto count_in = static_cast<double>(std::max<std::ptrdiff_t>(std::ranges::count(sides, 1), 1));
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (sides[i] == 0) continue;
      places.positions.push_back(candidates[i]);
      places.weights.push_back(sides[i] / count_in);
    }
    add_far(places, 1 / (count_in * grown_.volume() / static_cast<double>(candidates.size())));
  }

  /// Adds distant places, so that no solid extends there unnoticed.
  void add_far(LabelledPlaces& places, double weight_of_volume) const {
    const AlignedBox far = grown(grown_, k_far_margin * diagonal_);
    const std::size_t count = std::max<std::size_t>(options_.volume_places / 8, 1);
    const Points candidates = stratified(far, count, RandomStream(options_.seed, k_place_stage, 0)).places;
    const double weight = weight_of_volume * far.volume() / static_cast<double>(candidates.size());
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (grown_.contains(candidates[i])) continue;
      places.positions.push_back(candidates[i]);
      places.weights.push_back(-weight);
    }
  }

  void add_surface(LabelledPlaces& places) const {
    const std::vector<std::uint32_t> points =
        one_of_every_few(cloud_.size(), options_.surface_points, RandomStream(options_.seed, k_place_stage, 1));
    std::vector<double> depths(points.size());
    for_each_index_by_chunks(points.size(), k_chunk_places, run_,
                             [&](std::size_t i) { depths[i] = depth_at(points[i]); });
    double area = 0;
    for (const std::uint32_t point : points) area += areas_[point];
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (const int side : {-1, 1}) {
        const Eigen::Vector3d place = cloud_.positions[points[i]] + side * depths[i] * cloud_.normals[points[i]];
        if (side_by_nearest(place) != -side) continue;
        places.positions.push_back(place);
        places.weights.push_back(-side * 0.5 * areas_[points[i]] / area);
      }
    }
  }

 private:
  /// Moves each place that is nearer to a line of sight than to any point onto that line, where it is outside.
  /// @returns whether it moved, by place
  [[nodiscard]] std::vector<bool> move_onto_lines(LatticePlaces& lattice) const {
    // They put several lines into each cell that a sensor saw. With half, deep holes have cells with too few; double
    // only takes longer.
    constexpr std::size_t k_most_lines = 200'000;
    // One line may end at an outlier. With double, narrow holes have too few.
    constexpr std::uint32_t k_least_lines = 2;
    std::vector<bool> has_moved(lattice.places.size(), false);
    const std::vector<std::uint32_t> points =
        one_of_every_few(cloud_.size(), k_most_lines, RandomStream(options_.seed, k_place_stage, 2));
    const std::vector<SeenCell> seen = seen_cells(lattice, cloud_, points, 2 * clear_depth());
    for (std::size_t c = 0; c < seen.size(); ++c) {
      if (seen[c].lines < k_least_lines) continue;
      const double distance = std::max(seen[c].distance, k_near_spacings * spacing_);
      if (!index_.within(lattice.places[c], distance).empty()) continue;
      lattice.places.set(c, seen[c].place);
      has_moved[c] = true;
    }
    return has_moved;
  }

  /// So far from a point, a place is clearly on one side of its surface.
  [[nodiscard]] double clear_depth() const { return std::max({3 * noise_, 0.3 * spacing_, 0.002 * diagonal_}); }

  /// By the divergence theorem; negative for inward normals.
  [[nodiscard]] double enclosed_volume() const {
    double sum = 0;
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      sum += areas_[i] * cloud_.normals[i].dot(cloud_.positions[i] - grown_.center());
    }
    return sum / 3;
  }

  /// 1 inside, -1 outside, 0 unclear. Near points, the nearest ones decide unless the winding number contradicts it.
  [[nodiscard]] std::vector<int> sides_of(const Points& places, const std::vector<double>& numbers, double unit) const {
    std::vector<int> sides(places.size());
    for_each_index_by_chunks(places.size(), k_chunk_places, run_, [&](std::size_t i) {
      const double number = numbers[i] / unit;
      sides[i] = number > k_clear_in ? 1 : number < k_clear_out ? -1 : 0;
      // Far from all points this is much faster than looking for the nearest.
      if (index_.within(places[i], k_near_spacings * spacing_).empty()) return;
      const int by_nearest = side_by_nearest(places[i]);
      sides[i] = sides[i] == 0 || sides[i] == by_nearest ? by_nearest : 0;
    });
    return sides;
  }

  /// The side of the nearest point's plane; 0 within the noise, unless the points around are on the same side.
  [[nodiscard]] int side_by_nearest(const Eigen::Vector3d& place) const {
    const auto height = [&](std::uint32_t i) { return cloud_.normals[i].dot(place - cloud_.positions[i]); };
    const auto side = [&](std::uint32_t i) { return height(i) < 0 ? 1 : -1; };
    const std::uint32_t nearest = index_.nearest(place).point;
    if (std::abs(height(nearest)) > 1.5 * noise_) return side(nearest);
    constexpr std::size_t k_around = 8;  // agree by chance in one case of 128
    std::array<std::uint32_t, k_around> near{};
    std::array<double, k_around> squares{};
    const std::size_t found = index_.find(place, near, squares);
    const auto agrees = [&](std::uint32_t i) { return side(i) == side(nearest); };
    return std::ranges::all_of(std::span(near).first(found), agrees) ? side(nearest) : 0;
  }

  /// Distance of the places beside a point; less if another surface is near on either side.
  [[nodiscard]] double depth_at(std::uint32_t point) const {
    const double depth = clear_depth();
    const Eigen::Vector3d position = cloud_.positions[point];
    const Eigen::Vector3d normal = cloud_.normals[point];
    double least = depth;
    for (const std::uint32_t other : index_.within(position, 3 * depth)) {
      const Eigen::Vector3d offset = cloud_.positions[other] - position;
      const double height = std::abs(offset.dot(normal));
      const bool faces = cloud_.normals[other].dot(normal) < -0.5 && height > 0.7 * offset.norm();
      if (faces) least = std::min(least, 0.4 * height);
    }
    return least;
  }

  const PointCloud& cloud_;
  const PlaceOptions& options_;
  const RunContext& run_;
  NeighbourTree index_;
  std::vector<double> areas_;
  double diagonal_ = 0, spacing_ = 0, noise_ = 0;
  AlignedBox grown_;
};

}  // namespace

LabelledPlaces label_places(const PointCloud& cloud, const PlaceOptions& options, const RunContext& run,
                            std::span<const double> areas) {
  check(cloud, options, areas);
  const Labelling labelling(cloud, options, run, areas);
  LabelledPlaces places;
  labelling.add_volume(places);
  labelling.add_surface(places);
  return places;
}

double wrong_place_share(const CsgTree& tree, const PrimitiveSet& solids, const LabelledPlaces& places) {
  const std::vector<double> values = implicit_value(tree, solids, places.positions);
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((values[i] < 0) != (places.weights[i] > 0)) sum += std::abs(places.weights[i]);
  }
  return sum;
}

Eigen::Vector3d worst_place(const CsgTree& tree, const PrimitiveSet& solids, const LabelledPlaces& places) {
  const std::vector<double> values = implicit_value(tree, solids, places.positions);
  std::size_t worst = 0;
  double largest = -1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if ((values[i] < 0) == (places.weights[i] > 0) || std::abs(values[i]) <= largest) continue;
    worst = i;
    largest = std::abs(values[i]);
  }
  return places.positions[worst];
}

}  // namespace cloud2csg
