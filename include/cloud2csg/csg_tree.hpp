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
  primitive,     ///< leaf: a solid of the primitive set
  empty,         ///< leaf: no point at all
  full,          ///< leaf: all of space
  complement,    ///< one child
  union_of,      ///< two children
  intersection,  ///< two children
  difference,    ///< two children: the first less the second
};

/// "primitive", "empty", "full", "complement", "union", "intersection", "difference": as in files and pictures.
[[nodiscard]] std::string_view to_string(Operation operation);

[[nodiscard]] constexpr int arity(Operation operation) {
  return operation < Operation::complement ? 0 : operation == Operation::complement ? 1 : 2;
}

/// Eight bytes: an operation and, for a leaf, the primitive's index; for an inner node, the number of nodes of
/// its subtree, itself included.
class CsgNode {
 public:
  [[nodiscard]] static CsgNode leaf(PrimitiveIndex primitive) { return {Operation::primitive, primitive}; }
  [[nodiscard]] static CsgNode constant(Operation operation) { return {operation, 1}; }
  [[nodiscard]] static CsgNode inner(Operation operation, std::uint32_t length) { return {operation, length}; }

  [[nodiscard]] Operation operation() const { return operation_; }
  [[nodiscard]] bool is_leaf() const { return arity(operation_) == 0; }
  /// Precondition: operation() == Operation::primitive.
  [[nodiscard]] PrimitiveIndex primitive() const { return value_; }
  /// Nodes of the subtree that ends here.
  [[nodiscard]] std::uint32_t length() const { return operation_ == Operation::primitive ? 1 : value_; }

  friend bool operator==(const CsgNode&, const CsgNode&) = default;

 private:
  CsgNode(Operation operation, std::uint32_t value) : operation_(operation), value_(value) {}
  Operation operation_;
  std::uint32_t value_;
};
static_assert(sizeof(CsgNode) == 8);

/// A binary CSG tree as a flat postfix array: children before their parent, first child before the second,
/// the root last. A value: copying is a memcpy, a subtree is a contiguous range, crossover is a splice.
/// Invariant: well-formed, at least one node; every inner node's length is right.
class CsgTree {
 public:
  /// The empty solid: one node, Operation::empty.
  CsgTree() : nodes_{CsgNode::constant(Operation::empty)} {}
  /// A copy of a subtree's nodes (as subtree() gives them). Precondition: well-formed.
  explicit CsgTree(std::span<const CsgNode> postfix) : nodes_(postfix.begin(), postfix.end()) {}
  /// Takes over nodes that were built elsewhere. Precondition: well-formed.
  explicit CsgTree(std::vector<CsgNode> postfix) : nodes_(std::move(postfix)) {}

  [[nodiscard]] static CsgTree leaf(PrimitiveIndex primitive);
  [[nodiscard]] static CsgTree empty();
  [[nodiscard]] static CsgTree full();

  [[nodiscard]] std::span<const CsgNode> nodes() const { return nodes_; }
  /// Number of nodes, as in the paper's objective. O(1).
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  [[nodiscard]] std::size_t root() const { return nodes_.size() - 1; }

  /// The nodes of the subtree rooted at node index `root`: a contiguous range that ends there.
  [[nodiscard]] std::span<const CsgNode> subtree(std::size_t root) const {
    return nodes().subspan(root + 1 - nodes_[root].length(), nodes_[root].length());
  }
  /// Node index of the last (for complement: the only) child, and of the first child of a binary node.
  [[nodiscard]] std::size_t second_child(std::size_t node) const { return node - 1; }
  [[nodiscard]] std::size_t first_child(std::size_t node) const { return node - 1 - nodes_[node - 1].length(); }

  /// Replaces the subtree rooted at node index `root` by other nodes (not a range of this tree) and mends the
  /// lengths of the ancestors. O(size).
  void replace(std::size_t root, std::span<const CsgNode> replacement);

  friend bool operator==(const CsgTree&, const CsgTree&) = default;  ///< the same nodes in the same order

 private:
  std::vector<CsgNode> nodes_;
};

[[nodiscard]] CsgTree unite(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree intersect(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree subtract(const CsgTree& a, const CsgTree& b);
[[nodiscard]] CsgTree complement(const CsgTree& a);
/// Of none: the empty solid.
[[nodiscard]] CsgTree unite_all(std::span<const CsgTree> trees);

/// Edges on the longest path from the root to a leaf: 0 for a leaf. O(size), no recursion.
[[nodiscard]] std::size_t depth(const CsgTree& tree);
/// The same as a person writes it, each operation with as many operands as it has: `a | b | c` is one level, and so is
/// `a - b - c`. O(size), no recursion.
[[nodiscard]] std::size_t levels(const CsgTree& tree);
/// Leaves that are primitives, each counted as often as it appears.
[[nodiscard]] std::size_t leaf_count(const CsgTree& tree);
/// The primitives that appear, ascending, each once.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of(const CsgTree& tree);
/// Whether the tree is a single node, empty or full.
[[nodiscard]] bool is_constant(const CsgTree& tree);
/// The same tree with primitive p renamed to new_index[p].
[[nodiscard]] CsgTree renumber(const CsgTree& tree, std::span<const PrimitiveIndex> new_index);
/// The opposite of renumber(tree, members): each primitive is renamed to its place in `members`, which are ascending
/// and have all of the tree's. O(size x log members).
[[nodiscard]] CsgTree localised(const CsgTree& tree, std::span<const PrimitiveIndex> members);

/// Equal for trees that differ only by commutation and association of unions and intersections (and, within a
/// difference, by the order of what is subtracted: (a - b) - c and (a - c) - b). Others differ but for an accident of
/// 1 in 2^64. O(size).
[[nodiscard]] std::uint64_t structural_hash(const CsgTree& tree);
/// structural_hash of every subtree: one value per node index, in one pass. A part of a chain has the hash of
/// the part as it is stored: b | c within a | (b | c), but not within (a | b) | c. O(size).
[[nodiscard]] std::vector<std::uint64_t> structural_hashes(const CsgTree& tree);

/// Rewrites by rules of set algebra to a fixed point: idempotence (a | a), absorption (a | (a & b)), double
/// complement, De Morgan, complements turned into differences (a & ~b), empty and full, complementary pairs (a & ~a),
/// nested differences (a - (a - b) = a & b), anything that follows from what surrounds it ((a | b) - b = a - b), common
/// factors
/// ((a & b) | (a & c) = a & (b | c), (a - c) | (b - c) = (a | b) - c). Uses only the formula, no geometry.
///
/// Membership never changes, the size never grows, and a second simplify changes nothing. The result has one shape for
/// each formula: what is subtracted is united first (a - (b | c)), chains lean to the left, in the order of first
/// appearance, and a complement stands at most at the root, where the solid is unbounded: n leaves make 2 n - 1 nodes,
/// or 2 n. The result is a single node, empty or full, or holds neither. Mostly O(size log size), O(size^2) in the
/// worst case.
[[nodiscard]] CsgTree simplify(const CsgTree& tree);

/// Text form, e.g. `(a | b) - c`: `|` union, `&` intersection, `-` difference, `~` complement, `empty`, `full`.
/// `~` binds strongest, then `&`, then `|` and `-` alike, from the left. parse_tree(to_text(t)) is t up to association.
/// An id with other characters than letters, digits, `_`, `.` and `:` is written "in quotes", with \" and \\ inside.
[[nodiscard]] std::string to_text(const CsgTree& tree, const PrimitiveSet& primitives);
/// @throws Error (where = "column N", counted from 1 in characters) for a syntax error or a name that is not the id of
/// a primitive.
[[nodiscard]] CsgTree parse_tree(std::string_view text, const PrimitiveSet& primitives);

/// The tree's implicit value at points: union = min, intersection = max, complement = -f, difference = max(f, -g).
/// Negative inside; a distance near the surface, a lower bound elsewhere; +infinity for the empty solid, -infinity for
/// all of space. O(points x size).
[[nodiscard]] std::vector<double> implicit_value(const CsgTree& tree, const PrimitiveSet& primitives,
                                                 PointsView points);
/// Its gradient: that of the one primitive (up to sign) whose value the tree takes at each point, not normalised;
/// zero where the tree takes none (empty, full).
///
/// Which one, where several have the same |value|, does not depend on the tree's shape: min and max are taken in the
/// order of the **signed ranks** of the values, not of the values alone. The signed rank of +f_p at a point is the rank
/// of |f_p| among the primitives (from 1; equal ones by index, smaller index first) times the sign of f_p, where f_p ==
/// 0 counts as positive; that of -f_p is its negative. So of two equal positive values the one of the smaller index is
/// the smaller; of two equal negative ones, the one of the larger index.
[[nodiscard]] Points implicit_gradient(const CsgTree& tree, const PrimitiveSet& primitives, PointsView points);
/// Whether one point, given which primitives it is inside of (indexed by PrimitiveIndex), is in the solid.
[[nodiscard]] bool contains(const CsgTree& tree, const std::vector<bool>& inside_primitive);

/// Primitives and, where known, a tree over them: one solid.
struct Model {
  PrimitiveSet primitives = {};
  std::optional<CsgTree> tree = {};
  /// Free text about where the model comes from; kept when a file is read and written again.
  std::string description = {};
  /// Sentences for the user: what is doubtful about how it was read. Not written to files.
  std::vector<std::string> warnings = {};
};
/// The model's tree. Whatever takes a model as a solid needs one. @throws Error naming `file`, if one is given
[[nodiscard]] const CsgTree& tree_of(const Model& model, const std::string& file = {});

/// Graphviz: one box a node, labelled with the operation or the primitive's id. @throws Error without a tree
[[nodiscard]] std::string to_graphviz(const Model& model);

}  // namespace cloud2csg
