#include "quality/task.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <mutex>
#include <numeric>

#include "core/base/parallel.hpp"

namespace cloud2csg::bench {
namespace {

/// CPU time of the calling thread: other tasks and programs do not count.
double thread_seconds() {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The fault of an empty or unbounded tree; empty for others.
std::string fault_of(const CsgTree& tree, std::size_t primitives) {
  if (primitives_of(tree).empty()) return "empty tree";
  return contains(tree, std::vector<bool>(primitives, false)) ? "unbounded tree" : "";
}

Outcome extract_and_judge(const Task& task, const Setting& setting) {
  ExtractOptions options = setting.options;
  options.seed = task.seed;
  options.parallel = Parallel::none;
  Outcome outcome;
  try {
    const double start = thread_seconds();
    const Extraction result = extract_csg(task.cloud, task.primitives, options);
    const StageSeconds& wall = result.statistics.seconds;
    // Without the final measurement of the fit.
    outcome.milliseconds = 1e3 * (thread_seconds() - start) * wall.extraction / wall.total;
    outcome.failure = fault_of(result.tree(), task.primitives.size());
    if (!outcome.failure.empty()) return outcome;
    outcome.iou = task.judge->intersection_over_union(renumber(result.tree(), task.judge_index));
    outcome.is_proved = result.statistics.cells && result.statistics.cells->is_minimal;
    outcome.is_deeper = levels(result.tree()) > levels(*task.truth.tree);
    outcome.size_ratio = static_cast<double>(result.tree().size()) / static_cast<double>(task.truth.tree->size());
  } catch (const std::exception& error) {
    outcome.failure = error.what();
  }
  return outcome;
}

/// Writes the files of a task for inspection.
void keep(const std::filesystem::path& stem, const Task& task, const Setting& setting) {
  std::filesystem::create_directories(stem.parent_path());
  ExtractOptions options = setting.options;
  options.seed = task.seed;
  const auto file = [&stem](const char* ending) { return std::filesystem::path(stem.string() + ending); };
  write_model(file(".truth.json"), task.truth);
  write_model(file(".result.json"), extract_csg(task.cloud, task.primitives, options).model);
  write_point_cloud(file(".ply"), task.cloud);
}

/// A line that is overwritten on a terminal; elsewhere only the final one.
void show_progress(const std::string& label, std::size_t done, std::size_t count) {
  static const bool is_terminal = isatty(STDERR_FILENO) == 1;
  if (is_terminal) fmt::print(stderr, "\r");
  if (is_terminal || done == count) fmt::print(stderr, "{} {}/{}{}", label, done, count, done == count ? "\n" : "");
}

}  // namespace

Task make_task(const Model& model, PointCloud cloud, std::shared_ptr<const Judge> judge, std::uint64_t seed) {
  Task task{.judge = std::move(judge),
            .truth = model,
            .primitives = model.primitives,
            .judge_index = std::vector<PrimitiveIndex>(model.primitives.size()),
            .cloud = std::move(cloud),
            .seed = seed};
  std::iota(task.judge_index.begin(), task.judge_index.end(), PrimitiveIndex{0});
  return task;
}

std::vector<std::vector<Outcome>> run_tasks(const std::string& label, std::size_t count,
                                            const std::function<Task(std::size_t)>& make, const RunOptions& options) {
  std::vector<std::vector<Outcome>> outcomes(options.settings.size(), std::vector<Outcome>(count));
  std::mutex reporting;
  std::size_t done = 0;
  const RunContext run{.stop = {}, .on_progress = {}, .threads = options.threads};
  for_each_index(count, run, [&](std::size_t i) {
    const Task task = make(i);
    for (std::size_t s = 0; s < options.settings.size(); ++s) {
      outcomes[s][i] = extract_and_judge(task, options.settings[s]);
    }
    const std::lock_guard lock(reporting);
    show_progress(label, ++done, count);
  });
  for (std::size_t s = 0; s < options.settings.size() && !options.keep.empty() && count > 0; ++s) {
    const auto worst = std::ranges::min_element(outcomes[s], {}, &Outcome::iou) - outcomes[s].begin();
    std::string name = label + "." + options.settings[s].name;
    std::ranges::replace(name, ' ', '_');
    keep(options.keep / name, make(static_cast<std::size_t>(worst)), options.settings[s]);
  }
  return outcomes;
}

Summary summarise(std::span<const Outcome> outcomes, double right) {
  Summary summary{.count = outcomes.size()};
  std::vector<double> milliseconds;
  for (const Outcome& outcome : outcomes) {
    const bool is_right = outcome.iou >= right;
    summary.right += is_right ? 1 : 0;
    summary.worst_iou = std::min(summary.worst_iou, outcome.iou);
    summary.mean_iou += outcome.iou / static_cast<double>(outcomes.size());
    if (!outcome.failure.empty()) continue;
    const bool is_no_larger = outcome.size_ratio <= 1;
    summary.no_larger += is_no_larger ? 1 : 0;
    summary.proved += outcome.is_proved ? 1 : 0;
    summary.no_deeper += outcome.is_deeper ? 0 : 1;
    summary.right_and_no_larger += is_right && is_no_larger ? 1 : 0;
    summary.worst_ratio = std::max(summary.worst_ratio, outcome.size_ratio);
    summary.mean_ratio += outcome.size_ratio;
    milliseconds.push_back(outcome.milliseconds);
  }
  if (milliseconds.empty()) return summary;
  summary.mean_ratio /= static_cast<double>(milliseconds.size());
  std::ranges::sort(milliseconds);
  summary.median_milliseconds = milliseconds[milliseconds.size() / 2];
  return summary;
}

std::string share_text(std::size_t part, const Summary& summary) {
  return fmt::format("{}/{}", part, summary.count);
}

std::string iou_text(double iou) {
  return fmt::format("{:.5f}", iou);
}

std::string ratio_text(double ratio) {
  return fmt::format("{:.3f}", ratio);
}

std::string milliseconds_text(double milliseconds) {
  return fmt::format("{:.1f}", milliseconds);
}

std::string legend(double right) {
  return fmt::format(
      "right: IoU >= {}; no larger: nodes <= true nodes; proved: no smaller tree has the cells; no deeper: levels <= "
      "true levels; ratio: nodes / true nodes; ms: of the processor, median.",
      right);
}

std::string failures_text(std::span<const Outcome> outcomes) {
  std::map<std::string, std::size_t> counts;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.failure.empty()) ++counts[outcome.failure];
  }
  std::string text;
  for (const auto& [message, count] : counts) {
    text += fmt::format("{}{} x {}", text.empty() ? "" : "; ", count, message);
  }
  return text.empty() ? "0" : text;
}

}  // namespace cloud2csg::bench
