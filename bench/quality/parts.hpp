#pragma once

#include <cstddef>
#include <cstdint>

#include "quality/task.hpp"

/// The parts of the benchmark; each prints its tables.
namespace cloud2csg::bench {

struct QualityOptions {
  RunOptions run;
  std::size_t seeds = 50;  ///< runs per shipped model
  std::size_t random_models = 500;
  std::size_t defect_models = 50;  ///< part defects, in addition to the shipped ones
  std::size_t ablation_models = 200;
  std::size_t scan_models = 100;
  std::size_t cluster_models = 20;  ///< per size
  std::uint64_t first_seed = 1;     ///< seed of the first random model; the others follow
  double noise = 0.01;              ///< for shipped and random models
};

/// Compares the sampled IoU with that of compare().
void print_judge_check();
void print_models(const QualityOptions& options);
void print_random(const QualityOptions& options);
/// Models of one cluster, in which all solids overlap.
void print_clusters(const QualityOptions& options);
/// Clusters whose trees use some primitives several times.
void print_repeats(const QualityOptions& options);
void print_defects(const QualityOptions& options);
/// Displaced primitives before and after refine_primitives().
void print_refinement(const QualityOptions& options);
/// The effect of lines of sight in virtual scans; has settings of its own.
void print_scans(const QualityOptions& options);
/// The strategy by cells with one change at a time; has settings of its own.
void print_ablation(const QualityOptions& options);

}  // namespace cloud2csg::bench
