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

/// A cloud and primitives to extract from, and the truth to hold the tree against.
struct Task {
  std::shared_ptr<const Judge> judge;
  Model truth;                              ///< with a tree
  PrimitiveSet primitives;                  ///< those that are given to the extraction
  std::vector<PrimitiveIndex> judge_index;  ///< by primitive: its index for the judge
  PointCloud cloud;
  std::uint64_t seed = 1;  ///< of the search
};

/// All primitives of a model with its true tree.
[[nodiscard]] Task make_task(const Model& model, PointCloud cloud, std::shared_ptr<const Judge> judge,
                             std::uint64_t seed);

/// What became of a task under a setting.
struct Outcome {
  std::string failure = {};  ///< message of the exception, "empty tree", "unbounded tree"; then the IoU is 0
  double iou = 0;
  double size_ratio = 0;    ///< nodes / true nodes
  double milliseconds = 0;  ///< of the processor, as far as StageSeconds::extraction
  bool is_proved = false;   ///< no smaller tree has the cells
  bool is_deeper = false;   ///< more levels than the true tree, as a person writes them
};

struct RunOptions {
  std::vector<Setting> settings;
  int threads = 0;  ///< of the whole: a task has one; 0 = all cores
  /// A folder for the worst task of each call of run_tasks(), by IoU and by setting; empty: none is kept.
  std::filesystem::path keep = {};
};

/// Makes tasks 0 .. count - 1, several at a time, and extracts each by all settings on one thread. Outcomes by setting,
/// then by task; but for the times, they do not depend on the threads. Progress goes to the standard error. Kept tasks
/// are LABEL.SETTING.truth.json, .result.json and .ply, the label's spaces as underscores.
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
/// `right`: at least this IoU.
[[nodiscard]] Summary summarise(std::span<const Outcome> outcomes, double right);

/// Cells of a table.
[[nodiscard]] std::string share_text(std::size_t part, const Summary& summary);
[[nodiscard]] std::string iou_text(double iou);
[[nodiscard]] std::string ratio_text(double ratio);
[[nodiscard]] std::string milliseconds_text(double milliseconds);

/// What the columns of the tables are.
[[nodiscard]] std::string legend(double right);

/// "3 x message; 1 x other message"; "0" when nothing failed.
[[nodiscard]] std::string failures_text(std::span<const Outcome> outcomes);

}  // namespace cloud2csg::bench
