#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>
#include <variant>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/simplify.hpp"
#include "export/openscad_solids.hpp"
#include "export/openscad_text.hpp"
#include "mesh/model_extent.hpp"

namespace cloud2csg {
namespace {

// The module that stands for all of space.
constexpr const char* k_everything = "everything();";

/// A node as OpenSCAD writes it: one operator over any number of operands.
struct Block {
  const char* operation;             ///< "union", "intersection", "difference"
  std::vector<std::size_t> kept;     ///< nodes that are united or intersected
  std::vector<std::size_t> removed;  ///< nodes that are subtracted from that
};

/// What a chain of intersections, differences and complements keeps and what it removes:
/// ((a & b) - c) - (d | e) keeps a, b and removes c, d, e.
Block gather_intersection(const CsgTree& tree, std::size_t root) {
  struct Pending {
    std::size_t node;
    bool is_removed;
  };
  Block block{.operation = "difference", .kept = {}, .removed = {}};
  std::vector<Pending> pending{{root, false}};
  while (!pending.empty()) {
    const auto [node, is_removed] = pending.back();
    pending.pop_back();
    const Operation operation = tree.nodes()[node].operation();
    if (operation == Operation::complement) {
      pending.push_back({node - 1, !is_removed});
    } else if (operation == (is_removed ? Operation::union_of : Operation::intersection)) {
      pending.push_back({tree.second_child(node), is_removed});
      pending.push_back({tree.first_child(node), is_removed});
    } else if (operation == Operation::difference && !is_removed) {
      pending.push_back({tree.second_child(node), true});
      pending.push_back({tree.first_child(node), false});
    } else {
      (is_removed ? block.removed : block.kept).push_back(node);
    }
  }
  if (block.removed.empty()) block.operation = "intersection";
  return block;
}

Block gather_union(const CsgTree& tree, std::size_t root) {
  Block block{.operation = "union", .kept = {}, .removed = {}};
  std::vector<std::size_t> pending{root};
  while (!pending.empty()) {
    const std::size_t node = pending.back();
    pending.pop_back();
    if (tree.nodes()[node].operation() == Operation::union_of) {
      pending.push_back(tree.second_child(node));
      pending.push_back(tree.first_child(node));
    } else {
      block.kept.push_back(node);
    }
  }
  return block;
}

/// Writes the tree, indented. Without recursion: a chain may be as deep as it is long.
class TreePrinter {
 public:
  TreePrinter(const CsgTree& tree, std::span<const std::string> names) : tree_(tree), names_(names) {}

  std::string print() {
    to_do_.push_back({.node = tree_.root(), .text = {}, .level = 0});
    while (!to_do_.empty()) {
      const Item item = std::move(to_do_.back());
      to_do_.pop_back();
      if (item.text.empty()) {
        print_node(item.node, item.level);
      } else {
        print_line(item.text, item.level);
      }
    }
    return std::move(out_);
  }

 private:
  /// What is still to be written: a line, or a node if there is none.
  struct Item {
    std::size_t node;
    std::string text;
    std::size_t level;
  };

  void print_line(const std::string& text, std::size_t level) {
    constexpr std::size_t k_deepest = 40;  // a long chain must not grow quadratically
    out_.append(2 * std::min(level, k_deepest), ' ');
    out_ += text + "\n";
  }

  void print_node(std::size_t node, std::size_t level) {
    const CsgNode head = tree_.nodes()[node];
    if (head.operation() == Operation::primitive) {
      print_line(names_[head.primitive()] + "();", level);
    } else if (head.is_leaf()) {
      print_line(head.operation() == Operation::full ? k_everything : "union() {}  // the empty solid", level);
    } else if (head.operation() == Operation::union_of) {
      print_block(gather_union(tree_, node), level);
    } else {
      print_block(gather_intersection(tree_, node), level);
    }
  }

  void print_block(const Block& block, std::size_t level) {
    print_line(fmt::format("{}() {{", block.operation), level);
    // Last in, first out: what comes last is pushed first.
    to_do_.push_back({.node = 0, .text = "}", .level = level});
    const auto push = [this](std::span<const std::size_t> nodes, std::size_t inner_level) {
      for (std::size_t i = nodes.size(); i-- > 0;)
        to_do_.push_back({.node = nodes[i], .text = {}, .level = inner_level});
    };
    push(block.removed, level + 1);
    if (block.kept.empty()) {
      to_do_.push_back({.node = 0, .text = k_everything, .level = level + 1});
    } else if (block.removed.empty() || block.kept.size() == 1) {
      push(block.kept, level + 1);
    } else {
      to_do_.push_back({.node = 0, .text = "}", .level = level + 1});
      push(block.kept, level + 2);
      to_do_.push_back({.node = 0, .text = "intersection() {", .level = level + 1});
    }
  }

  const CsgTree& tree_;
  std::span<const std::string> names_;
  std::vector<Item> to_do_ = {};
  std::string out_ = {};
};

void validate(const OpenScadOptions& options) {
  const auto refuse = [](const char* field, int least, int found) {
    throw Error({.file = {},
                 .where = field,
                 .expected = fmt::format("expected {} or more, found {}", least, found),
                 .remedy = {}});
  };
  if (options.facets < 3) refuse("facets", 3, options.facets);
  if (options.mesh_resolution < 4) refuse("mesh_resolution", 4, options.mesh_resolution);
}

bool has_constants(const CsgTree& tree) {
  return std::any_of(tree.nodes().begin(), tree.nodes().end(), [](const CsgNode& node) {
    return node.operation() == Operation::empty || node.operation() == Operation::full;
  });
}

std::string module_text(const std::string& name, const Primitive& primitive, const openscad::SolidContext& context) {
  const std::string note = name == primitive.id ? "" : openscad::comment(primitive.id);
  return fmt::format("{}module {}() {{\n  {}\n}}\n", note, name, openscad::solid(primitive, context));
}

}  // namespace

std::string to_openscad(const CsgTree& tree, const PrimitiveSet& primitives, const OpenScadOptions& options) {
  validate(options);
  // OpenSCAD has neither an empty nor an infinite solid, so constants go as far as the formula allows.
  const CsgTree shown = has_constants(tree) ? simplify(tree) : tree;
  const AlignedBox everything = model_extent(tree, primitives);
  const openscad::SolidContext context{.everything = everything,
                                       .mesh_resolution = options.mesh_resolution,
                                       .number = openscad::NumberFormat(everything.sizes().maxCoeff())};
  const std::vector<std::string> names = openscad::module_names(primitives);

  std::string text = openscad::comment(options.comment);
  text += fmt::format("$fn = {};  // facets of a full circle\n\n", options.facets);
  text += TreePrinter(shown, names).print();
  std::string meshes;
  for (const PrimitiveIndex index : primitives_of(shown)) {
    const std::string module = module_text(names[index], primitives[index], context);
    (openscad::needs_mesh(primitives[index]) ? meshes : text) += "\n" + module;
  }
  if (text.find(k_everything) != std::string::npos) {
    text += fmt::format(
        "\n// All of space, as far as this model goes.\nmodule everything() {{\n  translate({}) cube({}, center = "
        "true);\n}}\n",
        context.number(everything.center()), context.number(everything.sizes().eval()));
  }
  // Long lists of triangles last: nobody edits them.
  return text + meshes;
}

}  // namespace cloud2csg
