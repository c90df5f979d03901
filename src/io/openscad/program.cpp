#include "io/openscad/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "core/base/text.hpp"
#include "core/primitive/profile.hpp"
#include "io/openscad/flat_shapes.hpp"
#include "io/openscad/join_shapes.hpp"
#include "io/openscad/path_functions.hpp"
#include "io/openscad/solid_key.hpp"
#include "io/openscad/solids.hpp"

namespace cloud2csg::scad {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// Numbers repeated names, except at their first use.
void number_names(PrimitiveSet& primitives) {
  std::map<std::string, std::size_t, std::less<>> count;
  for (const Primitive& primitive : primitives) count.emplace(primitive.id, 0);
  for (Primitive& primitive : primitives) {
    const std::string name = primitive.id;
    if (++count[name] == 1) continue;
    do {
      primitive.id = fmt::format("{}_{}", name, count[name]++);
    } while (count.contains(primitive.id));
    --count[name];
    count.emplace(primitive.id, 1);
  }
}

/// How many calls take as long as to find that the paths of the profile do not cross.
std::size_t calls_worth(const Profile& profile) {
  constexpr std::size_t k_pairs_per_call = 2000;
  const std::size_t segments = count_corners(profile);
  return segments * segments / k_pairs_per_call;
}

/// While this lives, a call's own $fn holds for its children.
class Inherited {
 public:
  Inherited(const Arguments& call, Variables& locals) : locals_(locals) {
    const auto own = std::ranges::find(call.values, "$fn", [](const auto& argument) { return argument.first; });
    if (own == call.values.end()) return;
    if (const auto outer = locals.find("$fn"); outer != locals.end()) outer_ = outer->second;
    locals.insert_or_assign("$fn", own->second);
    is_set_ = true;
  }
  ~Inherited() {
    if (!is_set_) return;
    if (outer_) {
      locals_.insert_or_assign("$fn", *outer_);
    } else {
      locals_.erase("$fn");
    }
  }
  Inherited(const Inherited&) = delete;
  Inherited& operator=(const Inherited&) = delete;

 private:
  Variables& locals_;
  std::optional<Value> outer_ = {};
  bool is_set_ = false;
};

/// A union, intersection or difference while its operands are read.
struct Block {
  Operation operation;
  std::size_t begin;      ///< first node in the postfix tree
  std::size_t count = 0;  ///< operands so far
  bool is_solid = false;  ///< whether the operands so far make a solid
};

/// Executes a program while reading it. Each statement appends its solid, if any, to the postfix tree. Loops and
/// modules are reread at each iteration and call.
class Program {
 public:
  explicit Program(std::string_view text) : reader_(text, globals_, locals_) {}

  Model read() {
    collect();
    reader_.go_to(0);
    Block all{.operation = Operation::union_of, .begin = 0};
    while (reader_.peek().kind != Token::Kind::end) {
      const Token first = reader_.next();
      const bool is_collected = first.raw == "module" || reader_.at("=");
      if (const auto functions = path_functions_.find(first.offset); functions != path_functions_.end()) {
        reader_.go_to(functions->second);
        continue;
      }
      reader_.go_to(first.offset);
      if (is_collected) {
        reader_.skip_statement();
      } else {
        add_statement(all, Affine3d::Identity());
      }
    }
    if (!all.is_solid) throw Refusal(0, "expected a solid, found none");
    number_names(primitives_);
    return {.primitives = std::move(primitives_), .tree = CsgTree(std::move(postfix_))};
  }

 private:
  /// Collects modules and variables first, because a program may use them before their definition.
  void collect() {
    while (reader_.peek().kind != Token::Kind::end) {
      const Token first = reader_.next();
      if (first.raw == "module") {
        collect_module();
      } else if (first.raw == "function" && take_path_functions(first)) {
        continue;
      } else if (first.kind == Token::Kind::name && reader_.take("=")) {
        // In OpenSCAD the last definition holds everywhere.
        if (!globals_.emplace(first.raw, reader_.value()).second) {
          throw Refusal(first.offset, "expected one value for a variable, found a second");
        }
        reader_.expect(";");
      } else {
        reader_.go_to(first.offset);
        reader_.skip_statement();
      }
    }
  }

  /// Takes the functions that our own files define, if they begin with this word and are the same, word by word.
  bool take_path_functions(const Token& first) {
    const Variables none;
    Reader expected(k_path_functions, none, none);
    reader_.go_to(first.offset);
    while (expected.peek().kind != Token::Kind::end && reader_.at(expected.peek().raw)) {
      expected.next();
      reader_.next();
    }
    const bool is_same = expected.peek().kind == Token::Kind::end;
    if (is_same) {
      path_functions_.emplace(first.offset, reader_.peek().offset);
    } else {
      reader_.go_to(first.offset);
      reader_.next();
    }
    return is_same;
  }

  void collect_module() {
    const Token name = reader_.next();
    reader_.expect("(");
    if (!reader_.take(")")) reader_.fail("a module without parameters");
    if (!modules_.emplace(name.raw, reader_.peek().offset).second) {
      throw Refusal(name.offset, "expected one module of this name, found two");
    }
    reader_.skip_statement();
  }

  void count_calls(std::size_t count) {
    // Modules that call modules could make any number of solids out of a few lines.
    constexpr std::size_t k_most = 2'000'000;
    calls_ += count;
    if (calls_ > k_most) {
      throw Refusal(reader_.peek().offset,
                    fmt::format("expected at most {} calls and loop iterations in all, found more", k_most));
    }
  }

  void add_statement(Block& block, const Affine3d& frame) {
    const Level level(reader_);
    const Token first = reader_.next();
    if (first.raw == ";") return;
    if (first.raw == "*" || first.raw == "%") return reader_.skip_statement();
    if (first.raw == "#") return add_statement(block, frame);
    if (first.kind == Token::Kind::name) return join(block, call(first, frame));
    reader_.go_to(first.offset);
    if (first.raw != "{") reader_.fail("a solid or an operation");
    join(block, add_children(Operation::union_of, frame));
  }

  /// Reads the children of a call: nothing, a statement or a block. Returns whether they make a solid.
  bool add_children(Operation operation, const Affine3d& frame) {
    Block block{.operation = operation, .begin = postfix_.size()};
    if (reader_.take("{")) {
      while (!reader_.take("}")) add_statement(block, frame);
    } else {
      add_statement(block, frame);
    }
    return block.is_solid;
  }

  /// Combines a block with the solid whose nodes were added last, if any.
  void join(Block& block, bool is_added) {
    const bool is_union = block.operation == Operation::union_of;
    if (is_added && block.is_solid) {
      const auto length = static_cast<std::uint32_t>(postfix_.size() - block.begin + 1);
      postfix_.push_back(CsgNode::inner(block.operation, length));
    } else if (block.count == 0 || is_union) {
      block.is_solid = block.is_solid || is_added;
    } else if (!block.is_solid || block.operation == Operation::intersection) {
      block.is_solid = false;  // empty minus something, or something and empty
      postfix_.erase(postfix_.begin() + static_cast<std::ptrdiff_t>(block.begin), postfix_.end());
    }
    ++block.count;
  }

  /// Returns whether the call makes a solid.
  bool call(const Token& name, const Affine3d& frame) {
    count_calls(1);
    if (const auto module = modules_.find(name.raw); module != modules_.end()) return call_module(*module, frame);
    if (name.raw == "for" || name.raw == "intersection_for") {
      reader_.expect("(");
      return repeat(name.raw == "for" ? Operation::union_of : Operation::intersection, frame);
    }
    const bool is_union = is_one_of(name.raw, {"union", "group", "render", "color"});
    const bool is_swept = is_one_of(name.raw, {"linear_extrude", "rotate_extrude"});
    const bool is_known =
        is_union || is_swept ||
        is_one_of(name.raw, {"difference", "intersection", "circle", "square", "polygon", "cube", "sphere", "cylinder",
                             "polyhedron", "translate", "rotate", "scale", "mirror", "multmatrix"});
    if (!is_known || !reader_.at("(")) {
      throw Refusal(name.offset, fmt::format("expected a solid, a map or an operation, found '{}'",
                                             visible_text(name.raw, k_longest_quote)));
    }
    const Arguments arguments = reader_.arguments(name);
    const Inherited inherited(arguments, locals_);
    if (name.raw == "difference") return add_children(Operation::difference, frame);
    if (name.raw == "intersection") return add_children(Operation::intersection, frame);
    if (is_union) return add_children(Operation::union_of, frame);
    if (is_swept) return add_swept(arguments, frame);
    if (const auto map = map_of(arguments)) return add_children(Operation::union_of, frame * *map);
    reader_.expect(";");
    const std::optional<LeafSolid> leaf = leaf_solid(arguments);
    if (!leaf) return add_flat(arguments, frame);
    add_leaf(leaf->shape, name.raw, frame * leaf->frame, name.offset);
    return true;
  }

  bool call_module(const std::pair<const std::string_view, std::size_t>& module, const Affine3d& frame) {
    for (const char* sign : {"(", ")", ";"}) reader_.expect(sign);
    const std::size_t back = reader_.peek().offset;
    const std::size_t before = primitives_.size();
    Variables outer = std::exchange(locals_, {});
    if (const auto facets = outer.find("$fn"); facets != outer.end()) locals_.insert(*facets);
    reader_.go_to(module.second);
    const bool is_solid = add_children(Operation::union_of, frame);
    locals_ = std::move(outer);
    reader_.go_to(back);
    if (primitives_.size() == before + 1) primitives_.back().id = module.first;
    return is_solid;
  }

  /// Reads a loop from its variable on, and combines the solids of all iterations.
  bool repeat(Operation operation, const Affine3d& frame) {
    const Level level(reader_);
    const Token variable = reader_.next();
    if (variable.kind != Token::Kind::name || !reader_.take("=")) {
      throw Refusal(variable.offset, "expected a variable and its values, as in for (i = [0 : 3])");
    }
    std::vector<Value> turns = reader_.turns();
    count_calls(turns.size());
    const bool is_last = !reader_.take(",");
    if (is_last) reader_.expect(")");
    const std::size_t rest = reader_.peek().offset;
    const Variables outer = locals_;
    Block block{.operation = operation, .begin = postfix_.size()};
    for (Value& turn : turns) {
      reader_.go_to(rest);
      locals_.insert_or_assign(variable.raw, std::move(turn));
      join(block, is_last ? add_children(Operation::union_of, frame) : repeat(operation, frame));
    }
    if (turns.empty()) {
      if (!is_last) reader_.skip_brackets();
      reader_.skip_statement();
    }
    locals_ = outer;
    return block.is_solid;
  }

  /// Adds a leaf to a temporary tree, which add_swept() removes.
  bool add_flat(const Arguments& call, const Affine3d& frame) {
    if (sweeping_call_.empty()) {
      throw Refusal(call.call.offset,
                    fmt::format("expected '{}' within linear_extrude or rotate_extrude", call.call.raw));
    }
    const Value* const points = call.find("points", 0);
    if (points != nullptr && points->is_path && path_functions_.empty()) {
      throw Refusal(points->offset, "expected a list of points, or path() as in files of cloud2csg");
    }
    const FlatShape shape{.profile = *flat_profile(call, sweeping_call_ == "rotate_extrude"),
                          .offset = call.call.offset};
    postfix_.push_back(CsgNode::leaf(static_cast<PrimitiveIndex>(flat_.size())));
    flat_.push_back(placed_in_plane(shape, frame));
    return true;
  }

  /// Reads the flat shapes in linear_extrude or rotate_extrude. Both keep what shapes have in common, so the tree over
  /// the shapes is one over their solids.
  bool add_swept(const Arguments& call, const Affine3d& frame) {
    const Token& name = call.call;
    if (!std::exchange(sweeping_call_, name.raw).empty()) refuse_solid(name.raw, name.offset);
    const Sweep sweep = sweep_of(call);
    const auto begin = static_cast<std::ptrdiff_t>(postfix_.size());
    (void)add_children(Operation::union_of, Affine3d::Identity());
    sweeping_call_ = {};
    const FlatTree shapes{.shapes = std::exchange(flat_, {}), .nodes = {postfix_.begin() + begin, postfix_.end()}};
    postfix_.erase(postfix_.begin() + begin, postfix_.end());
    const bool may_be_torus = !sweep.height && sweep.angle_deg == 360;
    if (const std::optional<LeafSolid> torus = may_be_torus ? torus_of(shapes) : std::nullopt) {
      add_leaf(torus->shape, "torus", frame * torus->frame, name.offset);
      return true;
    }
    const FlatTree few = joined(shapes);
    for (const CsgNode& node : few.nodes) {
      if (!node.is_leaf()) {
        postfix_.push_back(node);
        continue;
      }
      const FlatShape& shape = few.shapes[node.primitive()];
      count_calls(calls_worth(shape.profile));
      const Shape solid = swept(shape, sweep);
      add_leaf(solid, type_name(solid), frame * sweep.frame, shape.offset);
    }
    return !few.nodes.empty();
  }

  [[noreturn]] static void refuse_solid(std::string_view name, std::size_t offset) {
    throw Refusal(offset, fmt::format("expected a circle, square or polygon, found '{}'", name));
  }

  /// Reuses the primitive of an equal solid.
  void add_leaf(const Shape& shape, std::string_view name, const Affine3d& frame, std::size_t offset) {
    if (!sweeping_call_.empty()) refuse_solid(name, offset);
    Primitive primitive = place_solid(shape, frame, offset);
    primitive.id = name;
    try {
      validate(primitive);
    } catch (const Error& error) {
      throw Refusal(offset, fmt::format("{}: {}", error.parts().where, error.parts().expected));
    }
    const auto index = static_cast<PrimitiveIndex>(primitives_.size());
    const auto [known, is_new] = index_of_.emplace(key_of(primitive), index);
    if (is_new) primitives_.push_back(std::move(primitive));
    postfix_.push_back(CsgNode::leaf(known->second));
  }

  Variables globals_ = {};
  Variables locals_ = {};  ///< those of the enclosing loops
  Reader reader_;
  std::map<std::string_view, std::size_t> modules_ = {};  ///< offsets of their bodies
  PrimitiveSet primitives_ = {};
  std::map<std::vector<double>, PrimitiveIndex> index_of_ = {};
  std::vector<CsgNode> postfix_ = {};
  /// Begin and end of the functions that our files define.
  std::map<std::size_t, std::size_t> path_functions_ = {};
  std::string_view sweeping_call_ = {};  ///< whose shapes are being read
  std::vector<FlatShape> flat_ = {};
  std::size_t calls_ = 0;
};

}  // namespace

Model read_program(std::string_view text) {
  return Program(text).read();
}

}  // namespace cloud2csg::scad
