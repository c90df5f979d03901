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

/// A shape whose paths have boxes, because most paths are far from most others.
struct BoxedShape {
  Profile profile;
  std::vector<Eigen::AlignedBox2d> boxes = {};
  std::size_t segments = 0;
};

BoxedShape boxed(const Profile& profile) {
  BoxedShape shape{.profile = profile, .boxes = {}, .segments = count_corners(profile)};
  for (const ClosedPath& path : profile.paths) shape.boxes.push_back(bounds_of(segments_of(path)));
  return shape;
}

/// Whether the point is inside an odd number of paths.
bool contains(const BoxedShape& shape, const Eigen::Vector2d& point) {
  bool is_in = false;
  for (std::size_t i = 0; i < shape.boxes.size(); ++i) {
    if (shape.boxes[i].contains(point) && is_inside(segments_of(shape.profile.paths[i]), point)) is_in = !is_in;
  }
  return is_in;
}

/// Whether all paths of `inner` start inside `outer`, or all outside.
bool start_inside(const BoxedShape& inner, const BoxedShape& outer, bool is_expected) {
  return std::ranges::all_of(
      inner.profile.paths, [&](const ClosedPath& path) { return contains(outer, path.front().point) == is_expected; });
}

/// Whether paths touch while shapes are joined: taken to be apart, to be tested later all at once; or tested each time.
enum class Touching { later, at_once };

/// Builds the postfix tree anew, and joins shapes on the way.
class Joiner {
 public:
  Joiner(const FlatTree& tree, Touching touching) : tree_(tree), touching_(touching) {
    constexpr std::size_t k_pairs_per_segment = 5000;
    for (const FlatShape& shape : tree.shapes) {
      shapes_.push_back(boxed(shape.profile));
      pairs_left_ += k_pairs_per_segment * shapes_.back().segments;
    }
  }

  FlatTree join() {
    FlatTree fewer{.shapes = tree_.shapes};
    for (const CsgNode& node : tree_.nodes) {
      if (node.is_leaf()) {
        parts_.push_back({.begin = nodes_.size()});
        nodes_.push_back(node);
      } else {
        combine(node.operation());
      }
    }
    for (std::size_t i = 0; i < shapes_.size(); ++i) fewer.shapes[i].profile = std::move(shapes_[i].profile);
    fewer.nodes = std::move(nodes_);
    return fewer;
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
      BoxedShape& whole = shape_at(left);
      const BoxedShape& added = shape_at(right);
      whole.profile.paths.insert(whole.profile.paths.end(), added.profile.paths.begin(), added.profile.paths.end());
      whole.boxes.insert(whole.boxes.end(), added.boxes.begin(), added.boxes.end());
      whole.segments += added.segments;
      nodes_.pop_back();
      return;
    }
    left.chain = left.is_shape || left.chain == operation ? std::optional(operation) : std::nullopt;
    left.is_shape = false;
    nodes_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(nodes_.size() - left.begin + 1)));
  }

  BoxedShape& shape_at(const Part& part) { return shapes_[nodes_[part.begin].primitive()]; }

  /// Whether the paths of both together are the result. Where paths do not touch, one place of a path tells on which
  /// side of the other shape's paths it is.
  bool joins(const BoxedShape& whole, const BoxedShape& added, Operation operation) {
    // More would take seconds to test for crossings, as in a polygon.
    constexpr std::size_t k_most_segments = 10'000;
    if (whole.segments + added.segments > k_most_segments) return false;
    const bool is_cut = operation == Operation::difference;
    return start_inside(added, whole, is_cut) && start_inside(whole, added, false) &&
           (touching_ == Touching::later || are_apart(whole, added));
  }

  bool are_apart(const BoxedShape& whole, const BoxedShape& added) {
    Eigen::AlignedBox2d box;
    for (const Eigen::AlignedBox2d& of_path : added.boxes) box.extend(of_path);
    const double tolerance = 1e-6 * box.diagonal().norm();
    Profile near = added.profile;
    for (std::size_t i = 0; i < whole.boxes.size(); ++i) {
      if (whole.boxes[i].exteriorDistance(box) <= tolerance) near.paths.push_back(whole.profile.paths[i]);
    }
    const std::size_t segments = count_corners(near);
    if (segments * segments > pairs_left_) return false;
    pairs_left_ -= segments * segments;
    return has_clear_paths(near);
  }

  const FlatTree& tree_;
  Touching touching_;
  std::vector<BoxedShape> shapes_ = {};
  std::vector<CsgNode> nodes_ = {};
  std::vector<Part> parts_ = {};
  std::size_t pairs_left_ = 0;  ///< of segments that may still be tested; limits the time for any text
};

bool has_clear_shapes(const FlatTree& tree) {
  return std::ranges::all_of(tree.nodes, [&tree](const CsgNode& node) {
    if (!node.is_leaf()) return true;
    const Profile& profile = tree.shapes[node.primitive()].profile;
    return profile.paths.size() == 1 || has_clear_paths(profile);
  });
}

}  // namespace

FlatTree joined(const FlatTree& tree) {
  if (tree.nodes.size() < 2) return tree;
  for (const Touching touching : {Touching::later, Touching::at_once}) {
    FlatTree fewer = Joiner(tree, touching).join();
    if (has_clear_shapes(fewer)) return fewer;
  }
  return tree;
}

}  // namespace cloud2csg::scad
