#include "io/step/opencascade/evaluate.hpp"

#include <fmt/format.h>

#include <Standard_Failure.hxx>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "core/base/parallel.hpp"
#include "io/step/opencascade/booleans.hpp"
#include "io/step/opencascade/make_body.hpp"

namespace cloud2csg::brep {
namespace {

struct NodeResult {
  Bodies bodies = {};
  std::size_t healed_faces = 0;
  std::string failure = {};  ///< why the bodies are facets
  double deviation = 0;      ///< possible volume error of facets among the bodies
};

/// Trials of an operation, until one succeeds. Distances are relative to the model's size.
constexpr std::array<BooleanSettings, 5> k_trials{{{.fuzzy = 0, .one_by_one = false},
                                                   {.fuzzy = 1e-7, .one_by_one = false},
                                                   {.fuzzy = 1e-6, .one_by_one = true},
                                                   {.fuzzy = 1e-5, .one_by_one = false},
                                                   {.fuzzy = 1e-4, .one_by_one = false}}};

class Evaluator {
 public:
  Evaluator(const KernelJob& job, const KernelHost& host, SphereForm spheres, const FileTest& file_test)
      : job_(job), host_(host), spheres_(spheres), file_test_(file_test), results_(job.plan.nodes.size()) {
    for (const std::vector<std::size_t>& level : job.levels) total_ += level.size();
  }

  Evaluation evaluate() {
    for (const std::vector<std::size_t>& level : job_.levels) {
      for_each_index(level.size(), host_.run(), [&](std::size_t i) {
        results_[level[i]] = make(level[i]);
        report_one();
      });
    }
    Evaluation evaluation{.bodies = std::move(results_[job_.plan.root].bodies)};
    for (std::size_t i = 0; i < results_.size(); ++i) {
      evaluation.healed_faces += results_[i].healed_faces;
      if (!results_[i].failure.empty()) evaluation.failures.push_back({.node = i, .reason = results_[i].failure});
    }
    return evaluation;
  }

 private:
  [[nodiscard]] NodeResult make(std::size_t node) const {
    if (job_.plan.nodes[node].kind == PlanNode::Kind::primitive) return make_primitive(node);
    NodeResult result;
    if (!try_operations(node, result)) set_facets(node, result);
    return result;
  }

  [[nodiscard]] NodeResult make_primitive(std::size_t node) const {
    NodeResult result;
    const KernelSolid solid = host_.solid_of(job_.plan.nodes[node].primitive);
    try {
      result.bodies = make_bodies(solid, spheres_);
      if (std::holds_alternative<Facets>(solid.shape)) result.deviation = deviation_of(node, result.bodies);
      check_file(node, result);
    } catch (const BooleanFailure& failure) {
      result.failure = failure.what();
      set_facets(node, result);
    } catch (const Standard_Failure& failure) {
      result.failure = fmt::format("the kernel says: {}", failure.GetMessageString());
      set_facets(node, result);
    }
    return result;
  }

  /// Returns whether a trial succeeded; otherwise `result.failure` has the reason of the first failure.
  bool try_operations(std::size_t node, NodeResult& result) const {
    const PlanNode& plan = job_.plan.nodes[node];
    const double deviation = deviation_of_operands(plan);
    // A node with fewer than two operands needs no check.
    const auto expected = plan.kept.size() + plan.removed.size() > 1 ? host_.volume_of(node) : std::nullopt;
    for (BooleanSettings settings : k_trials) {
      settings.fuzzy *= job_.size;
      try {
        NodeResult trial{.bodies = combined(plan, settings), .deviation = deviation};
        heal(trial);
        if (expected) check_volume(trial, *expected);
        check_file(node, trial);
        result = std::move(trial);
        return true;
      } catch (const BooleanFailure& failure) {
        if (result.failure.empty()) result.failure = failure.what();
      } catch (const Standard_Failure& failure) {
        if (result.failure.empty()) result.failure = fmt::format("the kernel says: {}", failure.GetMessageString());
      }
    }
    return false;
  }

  [[nodiscard]] double deviation_of_operands(const PlanNode& node) const {
    double sum = 0;
    for (const auto* operands : {&node.kept, &node.removed}) {
      for (const std::size_t operand : *operands) sum += results_[operand].deviation;
    }
    return sum;
  }

  [[nodiscard]] double deviation_of(std::size_t node, const Bodies& facets) const {
    const std::optional<VolumeEstimate> expected = host_.volume_of(node);
    return expected ? std::abs(volume_of(facets) - expected->volume) : 0.0;
  }

  [[nodiscard]] Bodies combined(const PlanNode& node, const BooleanSettings& settings) const {
    const std::vector<Bodies> kept = bodies_of_nodes(node.kept);
    if (node.kind == PlanNode::Kind::union_of) return unite(kept, settings, host_.run());
    Bodies common = intersect(kept, settings, host_.run());
    return node.removed.empty() ? common : subtract(common, bodies_of_nodes(node.removed), settings, host_.run());
  }

  [[nodiscard]] std::vector<Bodies> bodies_of_nodes(const std::vector<std::size_t>& nodes) const {
    std::vector<Bodies> all;
    all.reserve(nodes.size());
    for (const std::size_t node : nodes) all.push_back(results_[node].bodies);
    return all;
  }

  static void heal(NodeResult& result) {
    Bodies mended;
    for (const Body& body : result.bodies) {
      if (is_valid(body.shape)) {
        mended.push_back(body);
        continue;
      }
      const Healed after = healed(body.shape);
      if (!is_valid(after.shape)) throw BooleanFailure("its result is invalid and cannot be repaired");
      result.healed_faces += after.faces;
      for (Body& part : bodies_of(after.shape)) mended.push_back(std::move(part));
    }
    result.bodies = std::move(mended);
  }

  void check_volume(const NodeResult& result, const VolumeEstimate& expected) const {
    constexpr double k_errors = 5;
    for (const Body& body : result.bodies) {
      if (!is_closed(body, job_.volume_tolerance)) throw BooleanFailure("its result has gaps in its surface");
    }
    const double volume = volume_of(result.bodies);
    const double allowed =
        result.deviation + std::max(k_errors * expected.error, job_.volume_tolerance * expected.volume);
    if (std::abs(volume - expected.volume) <= allowed) return;
    const double cube = std::pow(job_.frame.scale, 3);
    throw BooleanFailure(
        fmt::format("its result has volume {:.6g}, the tree {:.6g}", cube * volume, cube * expected.volume));
  }

  void check_file(std::size_t node, const NodeResult& result) const {
    if (!file_test_ || result.bodies.empty() || file_test_(node, result.bodies)) return;
    throw BooleanFailure("its result is invalid or a different solid when read from the file");
  }

  /// Replaces a node whose operation failed by facets. Appends to the failure if these fail, too.
  void set_facets(std::size_t node, NodeResult& result) const {
    try {
      result.bodies = make_bodies(host_.facets_of(node));
      result.deviation = deviation_of(node, result.bodies);
    } catch (const Standard_Failure& again) {
      result.failure += fmt::format("; and its facets make no solid: {}", again.GetMessageString());
      result.bodies.clear();
    }
  }

  void report_one() {
    const std::lock_guard lock(reporting_);
    host_.run().report("solid", ++done_, total_, "operations");
  }

  const KernelJob& job_;
  const KernelHost& host_;
  SphereForm spheres_;
  const FileTest& file_test_;
  std::vector<NodeResult> results_;
  std::mutex reporting_ = {};
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

}  // namespace

Evaluation evaluate(const KernelJob& job, const KernelHost& host, SphereForm spheres, const FileTest& file_test) {
  return Evaluator(job, host, spheres, file_test).evaluate();
}

}  // namespace cloud2csg::brep
