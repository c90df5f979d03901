#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "shape/sample/neighbourhood.hpp"
#include "shape/sample/primitive_surface.hpp"

namespace cloud2csg {

/// Throws the Error of a solid without any surface.
[[noreturn]] void refuse_without_surface();

/// @throws Error for an empty or unbounded solid.
[[nodiscard]] AlignedBox finite_bounds(const Model& model);

/// Draws candidates from the primitives' own surfaces and keeps those on the surface of the whole solid.
class SurfaceSampler {
 public:
  static constexpr std::size_t k_batch_candidates = 4096;

  /// @throws Error for an empty or unbounded solid; Cancelled. The primitives must outlive the sampler.
  SurfaceSampler(const Model& model, std::uint64_t seed, const RunContext& run);

  /// The area of all primitives' own surfaces, hidden or not.
  [[nodiscard]] double area() const { return area_; }

  /// The visible candidates of batches first .. first + count - 1, by batch. A batch is always the same. Many at once
  /// are faster, because each primitive's candidates are judged together. @throws Cancelled
  [[nodiscard]] std::vector<PointCloud> batches(std::size_t first, std::size_t count, const RunContext& run) const;

 private:
  struct Candidates {
    PointCloud points;
    std::vector<std::uint32_t> surface;  ///< index into surfaces_
  };
  enum class Verdict : std::uint8_t { hidden, outward, inward };
  /// Candidates of a batch that share a surface.
  struct Range {
    std::size_t batch, begin, end;
  };
  /// Ranges of one surface that are judged at once.
  struct Job {
    std::uint32_t surface = 0;
    std::size_t first = 0, last = 0;  ///< range indices
  };
  struct Plan {
    std::vector<Range> ranges;
    std::vector<Job> jobs;
  };

  [[nodiscard]] Candidates draw(std::size_t batch) const;
  [[nodiscard]] Candidates sorted_by_surface(const std::vector<SurfacePoint>& points,
                                             const std::vector<std::uint32_t>& surface) const;
  [[nodiscard]] Plan plan(const std::vector<Candidates>& batches) const;
  [[nodiscard]] std::vector<Verdict> judge(const PointCloud& candidates, std::uint32_t surface) const;
  void drop_duplicates(const PointCloud& candidates, std::uint32_t surface, std::span<Verdict> verdicts) const;
  [[nodiscard]] PointCloud visible(const Candidates& candidates, std::span<const Verdict> verdicts,
                                   std::size_t batch) const;

  const PrimitiveSet& primitives_;
  std::vector<PrimitiveIndex> used_;
  std::vector<PrimitiveSurface> surfaces_;  ///< by index into used_
  std::vector<Neighbourhood> neighbourhoods_;
  std::vector<double> cumulative_area_;
  double area_ = 0.0;
  double epsilon_ = 0.0;
  std::uint64_t seed_;
};

}  // namespace cloud2csg
