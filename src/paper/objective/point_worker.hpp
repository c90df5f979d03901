#pragma once

#include <vector>

#include "core/fields/point_blocks.hpp"
#include "paper/objective/class_table.hpp"

namespace cloud2csg {

/// The input of all workers.
template <class Real>
struct WorkerInput {
  PrimitiveSet primitives;                         ///< in the frame of the blocks
  std::vector<ContributionParameters> parameters;  ///< by primitive
  const PointCloud& cloud;
  AlignedBox box;                                         ///< bounds of the cloud
  std::vector<std::uint32_t> order;                       ///< see spatial_order()
  std::vector<Root> roots;                                ///< with regions in the frame of the blocks
  std::vector<std::vector<std::uint32_t>> roots_of = {};  ///< by primitive: roots that it is an owner of
  std::vector<std::uint32_t> roots_of_all_points = {};
  /// Empty for few primitives, which are all evaluated everywhere.
  std::vector<AlignedBox> reach = {};  ///< by primitive, in the frame of the blocks: where points may belong to it
};

/// A worker's results for its share of the points. Shares are added up at the end.
struct WorkerShare {
  std::vector<ClassTable> tables;  ///< one for each root
  std::vector<std::size_t> points_of_primitive;
  std::size_t unassigned = 0;
  double segment_seconds = 0;
  double classes_seconds = 0;

  /// Adds all but the tables.
  void absorb_counts(const WorkerShare& other);
};

/// Computes distances, memberships, contributions, ranks and classes of chunks of points. @throws Cancelled
template <class Real>
[[nodiscard]] WorkerShare work_on_chunks(const WorkerInput<Real>& input, std::size_t first, std::size_t last,
                                         const RunContext& run);

extern template WorkerShare work_on_chunks(const WorkerInput<double>&, std::size_t, std::size_t, const RunContext&);
extern template WorkerShare work_on_chunks(const WorkerInput<float>&, std::size_t, std::size_t, const RunContext&);

}  // namespace cloud2csg
