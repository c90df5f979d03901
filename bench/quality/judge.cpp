#include "quality/judge.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/random.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t k_judge_stream = 0x6a75646765;
constexpr std::size_t k_word = 64;

/// Uniform random places in the union of boxes, one per volume edge^3: jittered lattices without repeated regions.
Points places_in(std::span<const AlignedBox> boxes, double edge) {
  Points places;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    RandomStream random(0, k_judge_stream, b);
    const auto is_new = [&](const Vector3d& place) {
      return boxes[b].contains(place) &&
             std::ranges::none_of(boxes.first(b), [&](const AlignedBox& earlier) { return earlier.contains(place); });
    };
    const Vector3d first = (boxes[b].min() / edge).array().floor();
    const Vector3d last = (boxes[b].max() / edge).array().floor();
    const Eigen::Vector3i count = (last - first).cast<int>() + Eigen::Vector3i::Ones();
    for (int i = 0; i < count.x(); ++i) {
      for (int j = 0; j < count.y(); ++j) {
        for (int k = 0; k < count.z(); ++k) {
          const Vector3d jitter(random.uniform(), random.uniform(), random.uniform());
          const Vector3d place = edge * (first + Vector3d(i, j, k) + jitter);
          if (is_new(place)) places.push_back(place);
        }
      }
    }
  }
  return places;
}

/// About `wanted` places, uniform in the union of the boxes.
Points spread_places(std::span<const AlignedBox> boxes, std::size_t wanted) {
  double volume = 0;  // overlaps count twice, so the first try finds too few places
  for (const AlignedBox& box : boxes) volume += box.volume();
  const double edge = std::cbrt(volume / static_cast<double>(wanted));
  const double found = static_cast<double>(places_in(boxes, edge).size());
  return places_in(boxes, edge * std::cbrt(found / static_cast<double>(wanted)));
}

std::size_t count_of(std::span<const std::uint64_t> bits) {
  std::size_t sum = 0;
  for (const std::uint64_t word : bits) sum += static_cast<std::size_t>(std::popcount(word));
  return sum;
}

std::uint64_t combine(Operation operation, std::uint64_t first, std::uint64_t second) {
  if (operation == Operation::union_of) return first | second;
  return operation == Operation::intersection ? first & second : first & ~second;
}

}  // namespace

Judge::Judge(const PrimitiveSet& primitives, const CsgTree& truth, std::size_t places) {
  std::vector<AlignedBox> boxes;
  for (const Primitive& primitive : primitives) boxes.push_back(bounds(primitive));
  const Points points = spread_places(boxes, places);
  // Drops the last partial word, so that all words are full.
  words_ = points.size() / k_word;
  std::vector<double> distances(points.size());
  for (const Primitive& primitive : primitives) {
    evaluate_distance(primitive, points, distances);
    Bits bits(words_);
    for (std::size_t i = 0; i < words_ * k_word; ++i) {
      bits[i / k_word] |= (distances[i] < 0 ? std::uint64_t{1} : 0) << (i % k_word);
    }
    inside_primitive_.push_back(std::move(bits));
  }
  inside_truth_ = inside(truth);
}

double Judge::intersection_over_union(const CsgTree& tree) const {
  const bool is_unbounded = contains(tree, std::vector<bool>(inside_primitive_.size(), false));
  if (is_unbounded) return 0;
  Bits common = inside(tree);
  Bits either = common;
  for (std::size_t i = 0; i < words_; ++i) {
    common[i] &= inside_truth_[i];
    either[i] |= inside_truth_[i];
  }
  return static_cast<double>(count_of(common)) / static_cast<double>(count_of(either));
}

Judge::Bits Judge::leaf(const CsgNode& node) const {
  if (node.operation() == Operation::primitive) return inside_primitive_[node.primitive()];
  return Bits(words_, node.operation() == Operation::full ? ~std::uint64_t{0} : 0);
}

Judge::Bits Judge::inside(const CsgTree& tree) const {
  std::vector<Bits> stack;
  for (const CsgNode& node : tree.nodes()) {
    if (node.is_leaf()) {
      stack.push_back(leaf(node));
      continue;
    }
    if (node.operation() == Operation::complement) {
      for (std::uint64_t& word : stack.back()) word = ~word;
      continue;
    }
    const Bits second = std::move(stack.back());
    stack.pop_back();
    Bits& first = stack.back();
    for (std::size_t i = 0; i < words_; ++i) first[i] = combine(node.operation(), first[i], second[i]);
  }
  return std::move(stack.back());
}

}  // namespace cloud2csg::bench
