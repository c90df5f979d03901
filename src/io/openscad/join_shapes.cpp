#include "io/openscad/join_shapes.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "cloud2csg/error.hpp"
#include "core/primitive/profile.hpp"

namespace cloud2csg::scad {
namespace {

bool has_clear_paths(const Profile& profile) {
  try {
    validate_profile(profile);
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::size_t count_of_segments(const Profile& profile) {
  std::size_t count = 0;
  for (const ClosedPath& path : profile.paths) count += path.size();
  return count;
}

/// Whether all paths of `inner` start inside `outer`, or none.
bool start_inside(const Profile& inner, const Profile& outer, bool is_inside_expected) {
  std::vector<ProfileSegment> around;
  for (const ClosedPath& path : outer.paths) {
    const std::vector<ProfileSegment> segments = segments_of(path);
    around.insert(around.end(), segments.begin(), segments.end());
  }
  return std::ranges::all_of(
      inner.paths, [&](const ClosedPath& path) { return is_inside(around, path.front().point) == is_inside_expected; });
}

/// Builds the postfix tree anew, and joins shapes on the way.
class Joiner {
 public:
  explicit Joiner(FlatTree tree) : tree_(std::move(tree)) {
    std::size_t segments = 0;
    for (const FlatShape& shape : tree_.shapes) segments += count_of_segments(shape.profile);
    constexpr std::size_t k_pairs_per_segment = 20'000;
    pairs_left_ = k_pairs_per_segment * segments;
  }

  FlatTree join() {
    for (const CsgNode& node : std::exchange(tree_.nodes, {})) {
      if (node.is_leaf()) {
        parts_.push_back({.begin = tree_.nodes.size()});
        tree_.nodes.push_back(node);
      } else {
        combine(node.operation());
      }
    }
    return std::move(tree_);
  }

 private:
  /// A subtree. If all operations down its left side are the same, so is the meaning if its first shape is combined
  /// with another shape by this operation, rather than the whole.
  struct Part {
    std::size_t begin;
    bool is_shape = true;
    std::optional<Operation> chain = {};
  };

  void combine(Operation operation) {
    const Part right = parts_.back();
    parts_.pop_back();
    Part& left = parts_.back();
    const bool is_joinable =
        operation != Operation::intersection && right.is_shape && (left.is_shape || left.chain == operation);
    if (is_joinable && joins(shape_at(left), shape_at(right), operation)) {
      Profile& whole = shape_at(left).profile;
      const Profile& added = shape_at(right).profile;
      whole.paths.insert(whole.paths.end(), added.paths.begin(), added.paths.end());
      tree_.nodes.pop_back();
      return;
    }
    left.chain = left.is_shape || left.chain == operation ? std::optional(operation) : std::nullopt;
    left.is_shape = false;
    tree_.nodes.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(tree_.nodes.size() - left.begin + 1)));
  }

  FlatShape& shape_at(const Part& part) { return tree_.shapes[tree_.nodes[part.begin].primitive()]; }

  /// Whether the paths of both together are the result. They must not touch, so that one place of a path tells on which
  /// side of the other shape's paths it is.
  bool joins(const FlatShape& whole, const FlatShape& added, Operation operation) {
    constexpr std::size_t k_most_segments = 10'000;
    if (count_of_segments(whole.profile) + count_of_segments(added.profile) > k_most_segments) return false;
    const bool is_cut = operation == Operation::difference;
    if (!start_inside(added.profile, whole.profile, is_cut) || !start_inside(whole.profile, added.profile, false)) {
      return false;
    }
    const Eigen::AlignedBox2d box = bounds_of(added.profile);
    const double tolerance = 1e-6 * box.merged(bounds_of(whole.profile)).diagonal().norm();
    Profile near = added.profile;
    for (const ClosedPath& path : whole.profile.paths) {
      if (bounds_of(segments_of(path)).exteriorDistance(box) <= tolerance) near.paths.push_back(path);
    }
    const std::size_t segments = count_of_segments(near);
    if (segments * segments > pairs_left_) return false;
    pairs_left_ -= segments * segments;
    return has_clear_paths(near);
  }

  FlatTree tree_;
  std::vector<Part> parts_ = {};
  std::size_t pairs_left_ = 0;  ///< of segments that may still be tested; limits the time for any text
};

}  // namespace

FlatTree joined(FlatTree tree) {
  if (tree.nodes.size() < 2) return tree;
  FlatTree fewer = Joiner(tree).join();
  // Paths that are just apart among their neighbours may touch by the measure of a larger profile.
  const bool is_clear = std::ranges::all_of(fewer.nodes, [&](const CsgNode& node) {
    return !node.is_leaf() || fewer.shapes[node.primitive()].profile.paths.size() == 1 ||
           has_clear_paths(fewer.shapes[node.primitive()].profile);
  });
  return is_clear ? fewer : tree;
}

}  // namespace cloud2csg::scad
