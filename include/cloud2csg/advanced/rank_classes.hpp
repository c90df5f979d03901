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
/// At a point, a tree takes the value +f_p or -f_p of exactly one primitive p, and its gradient is that primitive's up
/// to sign. Which one depends only on the order of the values +-f_p there. So each point has a vector of signed ranks:
/// the rank (1 = smallest, ties by index) of |f_p| among the primitives, times the sign of f_p (0 counts as positive).
/// Min, max and negation act on signed ranks exactly as on distances. Points with the same vector form a class: every
/// tree selects the same signed primitive at all of them. So their scores are summed beforehand, for each of 2 n ranks.
namespace cloud2csg {

template <class T>
using AlignedVector = std::vector<T, boost::alignment::aligned_allocator<T, 64>>;

/// Working memory of an evaluation; one per thread, reused between calls.
struct RankScratch {
  AlignedVector<std::int8_t> bytes;
  AlignedVector<std::int16_t> words;
  std::vector<const void*> operands;
};

/// The table of one set of primitives and the points that judge trees over them. Trees use local indices 0 .. n - 1
/// into `primitives()`, and have the form of simplify(): a single constant, which scores nothing, or no constants.
class RankClasses {
 public:
  /// Up to this many primitives, a signed rank fits a byte; above, it takes two.
  static constexpr std::size_t k_byte_limit = 127;
  /// Up to this many primitives, classes are far fewer than points, and tables of subsets use a superset's classes.
  static constexpr std::size_t k_shared_limit = 24;

  [[nodiscard]] std::span<const PrimitiveIndex> primitives() const { return primitives_; }
  [[nodiscard]] std::size_t primitive_count() const { return primitives_.size(); }
  [[nodiscard]] std::size_t point_count() const { return point_count_; }
  [[nodiscard]] std::size_t class_count() const { return class_count_; }
  [[nodiscard]] const Objective& objective() const { return objective_; }

  /// E(t) without the cost of size: the sum over the points. O(classes x size / SIMD lanes + classes).
  [[nodiscard]] double geometry(const CsgTree& tree, RankScratch& scratch) const;
  /// The same, class by class: the reference for geometry().
  [[nodiscard]] double reference_geometry(const CsgTree& tree) const;
  /// E(t).
  [[nodiscard]] double score(const CsgTree& tree, RankScratch& scratch) const {
    return geometry(tree, scratch) - objective_.alpha * static_cast<double>(tree.size());
  }

  /// Upper bound on geometry(): the best signed primitive in every class.
  [[nodiscard]] double geometry_bound() const { return geometry_bound_; }

  /// By class: the share of its points in E(t). Shows where a tree is good.
  [[nodiscard]] std::vector<float> class_scores(const CsgTree& tree, RankScratch& scratch) const;
  /// By class: upper bound on class_scores().
  [[nodiscard]] std::span<const float> class_bounds() const { return bounds_; }
  /// Sums class values by the primitive nearest to their points (local indices).
  [[nodiscard]] std::vector<double> sums_by_nearest(std::span<const float> values) const;

  /// Column of signed ranks, for algorithms that build trees bottom-up from the values of subtrees: one entry per
  /// class, padded with zeros to padded_count(). Precondition: primitive_count() <= k_byte_limit.
  [[nodiscard]] std::span<const std::int8_t> column(PrimitiveIndex local) const;
  [[nodiscard]] std::size_t padded_count() const { return padded_count_; }
  /// Geometry of a column of selected ranks, and of its negation (the complement's).
  struct ColumnGeometry {
    double of_column;
    double of_negation;
  };
  [[nodiscard]] ColumnGeometry column_geometry(std::span<const std::int8_t> column) const;
  /// out = a operation b, for a binary operation; all spans have padded_count() entries, 64-byte aligned.
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
  /// By class, then by signed rank + n: 2 n + 1 entries per class, the middle one (rank 0) unused.
  AlignedVector<float> scores_;
  std::vector<std::uint16_t> nearest_;
  std::vector<float> bounds_;  ///< by class: largest score
};

struct RankClassesRequest {
  std::vector<PrimitiveIndex> primitives = {};  ///< at least one, ascending
  /// Some of the primitives, ascending: only their points are used. Empty: all, as in the paper's partitions.
  std::vector<PrimitiveIndex> owners = {};
  /// Use every k-th point only, along a curve and before the segmentation: bounds memory for large sets.
  std::size_t stride = 1;
  bool all_points = false;  ///< also points that belong to none of the primitives
  /// Leaves out points inside primitives outside of the set (beyond the paper), which no tree over the set can explain.
  bool without_strangers = false;
  /// Only points at or above the box's minimum and below its maximum, so adjacent boxes share none.
  std::optional<AlignedBox> region = {};
};

/// Precision of distances and angles. Ranks follow from them; sums are exact in any case.
enum class Precision {
  automatic,  ///< single where the noise is at least 3e-4 of the cloud's diagonal, far above rounding, and
              ///< gamma excludes surfaces seen from behind
  full,       ///< double: the ranks, ties included, equal the reference
  single,     ///< about twice as fast; relative change of scores below 1e-5 for clouds as above
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
  std::vector<RankClasses> tables;               ///< one per request
  std::vector<std::size_t> points_of_primitive;  ///< number of points that belong to each primitive
  std::size_t unassigned = 0;
  std::vector<std::uint32_t> order = {};  ///< all points along a space-filling curve
  double segment_seconds = 0;             ///< distances, gradients, membership, contributions; summed over threads
  double classes_seconds = 0;             ///< ranks, classes; summed over threads
};

/// The one pass over the points: signed distances and normals, segmentation, contributions, ranks and classes for all
/// requested sets at once. A set within another requested set shares its work. Neither the number of threads nor the
/// instruction set changes the result. Primitives without a request are only segmented. With many primitives, a point
/// meets only those near it and those requested together with one that it belongs to. O(points x primitives met), plus
/// O(size^2 / lanes) for each point and each requested set that takes it.
/// @throws Cancelled
[[nodiscard]] PointPass build_rank_classes(const PointCloud& cloud, const PrimitiveSet& primitives,
                                           std::span<const RankClassesRequest> requests,
                                           const PointPassOptions& options, const RunContext& run = {});

}  // namespace cloud2csg
