#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/experiment/table.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "quality/judge.hpp"
#include "quality/setting.hpp"

namespace cloud2csg::bench {

/// A cloud and primitives for an extraction, and the truth to judge its tree by.
struct Task {
  std::shared_ptr<const Judge> judge;
  Model truth;
  PrimitiveSet primitives;
  std::vector<PrimitiveIndex> judge_index;  ///< by primitive
  PointCloud cloud;
  std::uint64_t seed = 1;  ///< seed of the search
};

/// A task with all primitives of a model and its true tree.
[[nodiscard]] Task make_task(const Model& model, PointCloud cloud, std::shared_ptr<const Judge> judge,
                             std::uint64_t seed);

/// The result of a task under a setting.
struct Outcome {
  std::string failure = {};  ///< message of the exception, "empty tree", "unbounded tree"; then the IoU is 0
  double iou = 0;
  double size_ratio = 0;    ///< nodes / true nodes
  double milliseconds = 0;  ///< CPU time up to StageSeconds::extraction
  bool is_proved = false;   ///< proved: no smaller tree has the same cells
  bool is_deeper = false;   ///< levels() exceeds that of the true tree
};

struct RunOptions {
  std::vector<Setting> settings;
  int threads = 0;  ///< in total, with one per task; 0 = all cores
  /// Folder for the worst task of each call of run_tasks(), by IoU and by setting; empty: none is kept.
  std::filesystem::path keep = {};
};

/// Makes tasks 0 .. count - 1, several in parallel, and extracts each with all settings on one thread. Returns outcomes
/// by setting, then by task. Only times depend on the threads. Progress goes to standard error. Kept tasks are
/// LABEL.SETTING.truth.json, .result.json and .ply, with underscores for the label's spaces.
[[nodiscard]] std::vector<std::vector<Outcome>> run_tasks(const std::string& label, std::size_t count,
                                                          const std::function<Task(std::size_t)>& make,
                                                          const RunOptions& options);

/// The IoU from which a tree of a random model counts as right.
constexpr double k_right = 0.995;

struct Summary {
  std::size_t count = 0, right = 0, no_larger = 0, right_and_no_larger = 0, proved = 0, no_deeper = 0;
  double worst_iou = 1, mean_iou = 0;                               ///< failures count as 0
  double worst_ratio = 0, mean_ratio = 0, median_milliseconds = 0;  ///< without failures
};
/// `right`: the least IoU of a right tree.
[[nodiscard]] Summary summarise(std::span<const Outcome> outcomes, double right);

[[nodiscard]] std::string share_text(std::size_t part, const Summary& summary);
[[nodiscard]] std::string iou_text(double iou);
[[nodiscard]] std::string ratio_text(double ratio);
[[nodiscard]] std::string milliseconds_text(double milliseconds);

[[nodiscard]] std::string legend(double right);

/// "3 x message; 1 x other message"; "0" without failures.
[[nodiscard]] std::string failures_text(std::span<const Outcome> outcomes);

}  // namespace cloud2csg::bench
