#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud2csg/primitive.hpp"

/// The CSG tree: a formula of unions, intersections, differences and complements over primitives.
namespace cloud2csg {

enum class Operation : std::uint32_t {
  primitive,  ///< leaf: a solid of the primitive set
  empty,      ///< leaf: no point at all
  full,       ///< leaf: all of space
  complement,
  union_of,
  intersection,
  difference,  ///< two children: the first minus the second
};

/// "primitive", "empty", "full", "complement", "union", "intersection" or "difference", as in files and pictures.
[[nodiscard]] std::string_view to_string(Operation operation);

[[nodiscard]] constexpr int arity(Operation operation) {
  return operation < Operation::complement ? 0 : operation == Operation::complement ? 1 : 2;
}

/// An operation and a number, in eight bytes: the index of a leaf's primitive, or the size of an inner node's subtree.
class CsgNode {
 public:
  [[nodiscard]] static CsgNode leaf(PrimitiveIndex primitive) { return {Operation::primitive, primitive}; }
  [[nodiscard]] static CsgNode constant(Operation operation) { return {operation, 1}; }
  [[nodiscard]] static CsgNode inner(Operation operation, std::uint32_t length) { return {operation, length}; }

  [[nodiscard]] Operation operation() const { return operation_; }
  [[nodiscard]] bool is_leaf() const { return arity(operation_) == 0; }
  /// Precondition: operation() == Operation::primitive.
  [[nodiscard]] PrimitiveIndex primitive() const { return value_; }
  /// Number of nodes in the subtree that ends with this node.
  [[nodiscard]] std::uint32_t length() const { return operation_ == Operation::primitive ? 1 : value_; }

  friend bool operator==(const CsgNode&, const CsgNode&) = default;

 private:
  CsgNode(Operation operation, std::uint32_t value) : operation_(operation), value_(value) {}
  Operation operation_;
  std::uint32_t value_;
};
static_assert(sizeof(CsgNode) == 8);

/// A binary CSG tree as a flat postfix array: children stand before their parent, the first child before the second,
/// the root last. Copying is a memcpy, a subtree is a contiguous range, crossover is a splice.
/// Invariant: well-formed, at least one node, every inner node has the right length.
class CsgTree {
 public:
  CsgTree() : nodes_{CsgNode::constant(Operation::empty)} {}
  /// Copies the nodes of a subtree, as subtree() returns them. Precondition: well-formed.
  explicit CsgTree(std::span<const CsgNode> postfix) : nodes_(postfix.begin(), postfix.end()) {}
  /// Takes over nodes built elsewhere. Precondition: well-formed.
  explicit CsgTree(std::vector<CsgNode> postfix) : nodes_(std::move(postfix)) {}

  [[nodiscard]] static CsgTree leaf(PrimitiveIndex primitive);
  [[nodiscard]] static CsgTree empty();
  [[nodiscard]] static CsgTree full();

  [[nodiscard]] std::span<const CsgNode> nodes() const { return nodes_; }
  /// Number of nodes, as in the paper's objective. O(1).
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] std::size_t root() const { return nodes_.size() - 1; }

  /// The nodes of the subtree rooted at node index `root`: a contiguous range that ends at `root`.
  [[nodiscard]] std::span<const CsgNode> subtree(std::size_t root) const {
    return nodes().subspan(root + 1 - nodes_[root].length(), nodes_[root].length());
  }
  /// Node index of the last child (the only child of a complement), and of the first child of a binary node.
  [[nodiscard]] std::size_t second_child(std::size_t node) const { return node - 1; }
  [[nodiscard]] std::size_t first_child(std::size_t node) const { return node - 1 - nodes_[node - 1].length(); }

  /// Replaces the subtree rooted at node index `root` by nodes from elsewhere, and updates the ancestors. O(size).
  void replace(std::size_t root, std::span<const CsgNode> replacement);

  friend bool operator==(const CsgTree&, const CsgTree&) = default;

 private:
  std::vector<CsgNode> nodes_;
};

[[nodiscard]] CsgTree unite(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree intersect(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree subtract(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree complement(const CsgTree& a);
/// The union of all trees; the empty solid for an empty list.
[[nodiscard]] CsgTree unite_all(std::span<const CsgTree> trees);

/// Number of edges on the longest path from the root to a leaf; 0 for a leaf. O(size), no recursion.
[[nodiscard]] std::size_t depth(const CsgTree& tree);
/// Depth with chains as single nodes: `a | b | c` is one level, and so is `a - b - c`. O(size), no recursion.
[[nodiscard]] std::size_t levels(const CsgTree& tree);
/// Number of primitive leaves, repetitions included.
[[nodiscard]] std::size_t leaf_count(const CsgTree& tree);
/// The primitives in the tree, ascending, without repetitions.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of(const CsgTree& tree);
/// Whether the tree is a single node, empty or full.
[[nodiscard]] bool is_constant(const CsgTree& tree);
/// The same tree with primitive p renamed to new_index[p].
[[nodiscard]] CsgTree renumber(const CsgTree& tree, std::span<const PrimitiveIndex> new_index);
/// The inverse of renumber(tree, members): `members` are ascending and contain all primitives. O(size x log members).
[[nodiscard]] CsgTree localised(const CsgTree& tree, std::span<const PrimitiveIndex> members);

/// A hash that ignores the order and grouping of operands in unions and intersections, and the order of subtracted
/// operands: (a - b) - c equals (a - c) - b. All other trees collide with probability 2^-64. O(size).
[[nodiscard]] std::uint64_t structural_hash(const CsgTree& tree);
/// structural_hash of every subtree in one pass, by node index. A part of a chain has a hash only where it is stored as
/// a subtree: b | c in a | (b | c), but not in (a | b) | c. O(size).
[[nodiscard]] std::vector<std::uint64_t> structural_hashes(const CsgTree& tree);

/// Applies rules of set algebra to a fixed point: idempotence (a | a), absorption (a | (a & b)), double complement, De
/// Morgan, complements as differences (a & ~b), empty and full, complementary pairs (a & ~a), nested differences (a -
/// (a - b) = a & b), simplification by the surrounding formula ((a | b) - b = a - b), and common factors ((a & b) | (a
/// & c) = a & (b | c), (a - c) | (b - c) = (a | b) - c). Uses only the formula, no geometry.
///
/// Membership never changes, the size never grows, and a second call changes nothing. The result is a normal form:
/// - Subtracted operands are united first: a - (b | c).
/// - Chains associate to the left, in the order of first appearance.
/// - A complement stands only at the root, and only for an unbounded solid. So n leaves make 2 n - 1 nodes, or 2 n.
/// - Constants stand alone: the result is a single empty or full node, or contains neither.
/// Mostly O(size log size), O(size^2) in the worst case.
[[nodiscard]] CsgTree simplify(const CsgTree& tree);

/// The text form, e.g. `(a | b) - c`: `|` union, `&` intersection, `-` difference, `~` complement, `empty`, `full`. `~`
/// binds strongest, then `&`. `|` and `-` have equal precedence and associate to the left. parse_tree(to_text(t)) is t
/// up to association. An id with other characters than letters, digits, `_.:` is "quoted", with \" and \\ inside.
[[nodiscard]] std::string to_text(const CsgTree& tree, const PrimitiveSet& primitives);
/// @throws Error (where = "column N", counted from 1 in characters) for a syntax error or an unknown primitive id.
[[nodiscard]] CsgTree parse_tree(std::string_view text, const PrimitiveSet& primitives);

/// The tree's implicit value at points: union = min, intersection = max, complement = -f, difference = max(f, -g).
/// Negative inside; distance near the surface, lower bound elsewhere; +infinity for empty, -infinity for full. O(points
/// x size).
[[nodiscard]] std::vector<double> implicit_value(const CsgTree& tree, const PrimitiveSet& primitives,
                                                 PointsView points);
/// Gradient of implicit_value(), not normalised: that of the selected primitive up to sign; zero for empty and full.
///
/// Which primitive is chosen among those of equal |value| does not depend on the tree's shape: min and max compare the
/// **signed ranks** of the values. The signed rank of +f_p at a point is the rank of |f_p| among the primitives times
/// the sign of f_p; that of -f_p is its negative. Ranks start at 1, ties go by index, and f_p == 0 counts as positive.
/// So of equal positive values the smaller index is smaller; of equal negative values, the larger index.
[[nodiscard]] Points implicit_gradient(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points);
/// Whether a point is in the solid. `inside_primitive` tells by PrimitiveIndex which primitives contain the point.
[[nodiscard]] bool contains(const CsgTree& tree, const std::vector<bool>& inside_primitive);

/// Primitives and, where known, a tree over them.
struct Model {
  PrimitiveSet primitives = {};
  std::optional<CsgTree> tree = {};
  /// Free text about the origin of the model; kept when a file is read and written again.
  std::string description = {};
  /// Sentences for the user about doubtful parts of the input. Not written to files.
  std::vector<std::string> warnings = {};
};
/// The model's tree. @throws Error when there is none, naming `file` if given
[[nodiscard]] const CsgTree& tree_of(const Model& model, const std::string& file = {});

/// Graphviz text with one box per node, labelled with the operation or the primitive's id. @throws Error without a tree
[[nodiscard]] std::string to_graphviz(const Model& model);

}  // namespace cloud2csg
