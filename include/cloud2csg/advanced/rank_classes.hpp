#pragma once

#include <array>
#include <boost/align/aligned_allocator.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "cloud2csg/advanced/objective.hpp"
#include "cloud2csg/advanced/segmentation.hpp"

/// Rank classes: the objective of any tree from a table that is made once.
///
/// At a point, a tree over primitives p takes the value +f_p or -f_p of exactly one of them, and its gradient is that
/// primitive's up to sign. Which one depends only on the order of the values +-f_p there. So each point has a vector of
/// signed ranks: the rank (1 = smallest, ties by index) of |f_p| among the primitives, times the sign of f_p (0 counts
/// as positive); min, max and negation act on them exactly as on distances. Points with the same vector form a class:
/// every tree selects the same signed primitive at all of them, so their scores can be summed beforehand, once for each
/// of the 2 n signed ranks.
namespace cloud2csg {

template <class T>
using AlignedVector = std::vector<T, boost::alignment::aligned_allocator<T, 64>>;

/// Working memory of an evaluation; one a thread, reused between calls.
struct RankScratch {
  AlignedVector<std::int8_t> bytes;
  AlignedVector<std::int16_t> words;
  std::vector<const void*> operands;
};

/// The table of one set of primitives and the points that judge trees over them. Trees given to it index the
/// primitives by their place in `primitives()`: local indices 0 .. n - 1. They are as simplify() leaves them: the empty
/// solid or all of space, which score nothing, or without any of the two within.
class RankClasses {
 public:
  /// Up to this many primitives a signed rank fits a byte; above it takes two.
  static constexpr std::size_t k_byte_limit = 127;
  /// Up to this many primitives the surfaces where ranks change cut a cloud into far fewer classes than it has points.
  /// Tables of subsets are then made from the classes of one that contains them, not from the points.
  static constexpr std::size_t k_shared_limit = 24;

  [[nodiscard]] std::span<const PrimitiveIndex> primitives() const { return primitives_; }
  [[nodiscard]] std::size_t primitive_count() const { return primitives_.size(); }
  [[nodiscard]] std::size_t point_count() const { return point_count_; }
  [[nodiscard]] std::size_t class_count() const { return class_count_; }
  [[nodiscard]] const Objective& objective() const { return objective_; }

  /// The sum over the points of E(t): all of it but the cost of size. O(classes x size / SIMD lanes + classes).
  [[nodiscard]] double geometry(const CsgTree& tree, RankScratch& scratch) const;
  /// The same, one class after the other: what geometry() is held against.
  [[nodiscard]] double reference_geometry(const CsgTree& tree) const;
  /// E(t).
  [[nodiscard]] double score(const CsgTree& tree, RankScratch& scratch) const {
    return geometry(tree, scratch) - objective_.alpha * static_cast<double>(tree.size());
  }

  /// The sum that a tree would reach if it could choose the best signed primitive in every class: no tree scores more.
  [[nodiscard]] double geometry_bound() const { return geometry_bound_; }

  /// Scores by class, for judging where a tree is good: one value a class, what its points add to E(t).
  [[nodiscard]] std::vector<float> class_scores(const CsgTree& tree, RankScratch& scratch) const;
  /// The best that any tree can score in each class.
  [[nodiscard]] std::span<const float> class_bounds() const { return bounds_; }
  /// Values of classes summed by the primitive that is nearest to their points (local indices).
  [[nodiscard]] std::vector<double> sums_by_nearest(std::span<const float> values) const;

  /// Columns of signed ranks, for algorithms that build trees bottom-up and keep the values of their parts: one entry a
  /// class, padded with zeros to padded_count(). Precondition: primitive_count() <= k_byte_limit.
  [[nodiscard]] std::span<const std::int8_t> column(PrimitiveIndex local) const;
  [[nodiscard]] std::size_t padded_count() const { return padded_count_; }
  /// The geometry of a column of selected ranks, and of its negation (the complement's).
  struct ColumnGeometry {
    double of_column;
    double of_negation;
  };
  [[nodiscard]] ColumnGeometry column_geometry(std::span<const std::int8_t> column) const;
  /// out = a operation b, for a binary operation; all of padded_count() entries, 64-byte aligned.
  static void combine(Operation operation, std::span<const std::int8_t> a, std::span<const std::int8_t> b,
                      std::span<std::int8_t> out);

 private:
  friend class RankClassesBuilder;

  std::vector<PrimitiveIndex> primitives_;
  std::size_t point_count_ = 0;
  std::size_t class_count_ = 0;
  std::size_t padded_count_ = 0;
  Objective objective_{};
  double geometry_bound_ = 0;
  /// By primitive, then by class.
  std::variant<AlignedVector<std::int8_t>, AlignedVector<std::int16_t>> ranks_;
  /// By class, then by signed rank + n: 2 n + 1 entries a class, the middle one (rank 0) unused.
  AlignedVector<float> scores_;
  std::vector<std::uint16_t> nearest_;
  std::vector<float> bounds_;  ///< by class: the largest of its scores
};

/// A set of primitives to make a table for.
struct RankClassesRequest {
  std::vector<PrimitiveIndex> primitives = {};  ///< at least one, ascending
  /// Points are taken that belong to one of these; empty: to one of the primitives, as the paper's partitions do.
  /// Some of the primitives, ascending.
  std::vector<PrimitiveIndex> owners = {};
  /// Use every k-th point only (along a curve through the cloud, before the choice by segmentation): bounds memory for
  /// large sets.
  std::size_t stride = 1;
  bool all_points = false;  ///< also those that belong to none of the primitives
  /// Not those inside a primitive that is not in the set (beyond the paper): there the set does not tell the whole, and
  /// no tree over it can explain, say, the part of a bore that lies in another block.
  bool without_strangers = false;
  /// Only points at or above the box's minimum and below its maximum: boxes side by side share none.
  std::optional<AlignedBox> region = {};
};

/// In which precision distances and angles are computed. Ranks follow from them; sums are exact in any case.
enum class Precision {
  automatic,  ///< single where the noise is at least 3e-4 of the cloud's diagonal, since rounding is then far below it,
              ///< and gamma is not so small that surfaces seen from behind count
  full,       ///< double: the ranks, ties included, are those of the reference
  single,     ///< about twice as fast; scores move by less than 1e-5 of themselves for clouds as above
};

constexpr auto names_of(Precision /*any*/) {
  return std::to_array<EnumName<Precision>>(
      {{"auto", Precision::automatic}, {"full", Precision::full}, {"single", Precision::single}});
}

struct PointPassOptions {
  SegmentationTolerances tolerances;
  ObjectiveOptions objective = {};
  double noise;  ///< see estimate_noise()
  Precision precision = Precision::automatic;
};

struct PointPass {
  std::vector<RankClasses> tables;               ///< one a request
  std::vector<std::size_t> points_of_primitive;  ///< how many points belong to each primitive
  std::size_t unassigned = 0;                    ///< points that belong to no primitive
  std::vector<std::uint32_t> order = {};         ///< all points, so that neighbours are near each other
  double segment_seconds = 0;                    ///< of all threads: distances, gradients, membership, contributions
  double classes_seconds = 0;                    ///< of all threads: ranks, classes
};

/// The one pass over the points: signed distances and normals, segmentation, contributions, ranks and classes for
/// all requested sets at once. Sets that are part of another requested one share its work. The result does not depend
/// on the number of threads or the instruction set. Primitives that no request names are only segmented. Of many
/// primitives, only those near a point and those requested together with one that it belongs to are looked at. O(points
/// x those looked at), and for each point and each requested set that takes it, O(size^2 / lanes) more.
/// @throws Cancelled
[[nodiscard]] PointPass build_rank_classes(const PointCloud& cloud, const PrimitiveSet& primitives,
                                           std::span<const RankClassesRequest> requests,
                                           const PointPassOptions& options, const RunContext& run = {});

}  // namespace cloud2csg
