#pragma once

#include <cstddef>
#include <cstdint>

#include "quality/task.hpp"

/// The parts of the benchmark; each prints its tables.
namespace cloud2csg::bench {

struct QualityOptions {
  RunOptions run;
  std::size_t seeds = 50;           ///< runs a shipped model
  std::size_t random_models = 500;  ///< of part random
  std::size_t defect_models = 50;   ///< of part defects, beside the shipped ones
  std::size_t ablation_models = 200;
  std::size_t scan_models = 100;
  std::size_t cluster_models = 20;  ///< of each size
  std::uint64_t first_seed = 1;     ///< of random models; the others follow
  double noise = 0.01;              ///< of shipped and random models
};

/// The sampled IoU against that of compare().
void print_judge_check();
void print_models(const QualityOptions& options);
void print_random(const QualityOptions& options);
/// Each model one cluster, in which all solids meet.
void print_clusters(const QualityOptions& options);
/// Clusters whose trees use some primitives several times.
void print_repeats(const QualityOptions& options);
void print_defects(const QualityOptions& options);
/// Primitives that are off, before and after refine_primitives().
void print_refinement(const QualityOptions& options);
/// What lines of sight tell beyond the points of virtual scans; has settings of its own.
void print_scans(const QualityOptions& options);
/// The strategy by cells with each of its parts changed alone; has settings of its own.
void print_ablation(const QualityOptions& options);

}  // namespace cloud2csg::bench
