#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/primitive/lengths.hpp"
#include "io/openscad/leaf_solids.hpp"
#include "io/openscad/place_solid.hpp"
#include "io/openscad/syntax.hpp"
#include "io/openscad/transforms.hpp"
#include "io/openscad/values.hpp"

namespace cloud2csg {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using scad::Scope;
using scad::Statement;
using Kind = Statement::Kind;

// Modules that call modules could make any number of solids out of a few lines.
constexpr std::size_t k_most_calls = 1'000'000;

constexpr std::array<std::string_view, 10> k_no_solids{"hull",    "minkowski", "linear_extrude", "offset", "projection",
                                                       "surface", "import",    "text",           "resize", "roof"};

bool is_plain_union(std::string_view name) {
  constexpr std::array<std::string_view, 4> k_names{"union", "group", "render", "color"};
  return std::ranges::find(k_names, name) != k_names.end();
}

/// All numbers of a solid and where it is: those of equal solids are equal.
std::vector<double> numbers_of(const Primitive& primitive) {
  std::vector<double> numbers{static_cast<double>(primitive.shape.index())};
  const auto add = [&numbers](const auto& vector) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) numbers.push_back(vector[i]);
  };
  add(primitive.pose.position);
  add(primitive.pose.orientation.coeffs());
  const std::vector<double> lengths = lengths_of(primitive.shape);
  numbers.insert(numbers.end(), lengths.begin(), lengths.end());
  if (const auto* polytope = std::get_if<Polytope>(&primitive.shape)) {
    for (const Plane& plane : polytope->planes) {
      add(plane.normal);
      numbers.push_back(plane.offset);
    }
  }
  return numbers;
}

/// Carries statements out: each adds the nodes of its solid to the end of the tree, or none.
class Builder {
 public:
  explicit Builder(std::string_view text) : text_(text) {}

  Model build(const std::vector<Statement>& statements) {
    for (const Statement& statement : statements) {
      if (statement.kind != Kind::module_definition) continue;
      if (!modules_.emplace(statement.name, &statement).second) {
        scad::refuse(text_, statement.offset, fmt::format("expected one module '{}', found two", statement.name));
      }
    }
    assign(statements, globals_);
    if (!combine(Operation::union_of, statements, globals_, Affine3d::Identity())) {
      throw Error({.file = {}, .where = {}, .expected = "expected a solid, found none", .remedy = {}});
    }
    name_primitives();
    return {.primitives = std::move(primitives_), .tree = CsgTree(std::move(postfix_))};
  }

 private:
  /// Held while something is inside of something.
  class Level {
   public:
    Level(Builder& builder, const Statement& at) : builder_(builder) {
      if (builder_.level_ >= scad::k_deepest || ++builder_.calls_ > k_most_calls) {
        scad::refuse(builder_.text_, at.offset,
                     fmt::format("expected at most {} calls in each other and {} in all, found more", scad::k_deepest,
                                 k_most_calls));
      }
      ++builder_.level_;
    }
    ~Level() { --builder_.level_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    Level(Level&&) = delete;
    Level& operator=(Level&&) = delete;

   private:
    Builder& builder_;
  };

  /// Variables have their last value everywhere in a block of OpenSCAD: refused where there are two.
  void assign(const std::vector<Statement>& statements, Scope& scope) const {
    for (const Statement& statement : statements) {
      if (statement.kind != Kind::assignment || !statement.is_shown) continue;
      if (scope.values.contains(statement.name)) {
        scad::refuse(text_, statement.offset, fmt::format("expected one value of '{}', found a second", statement.name),
                     scad::k_flatten);
      }
      scope.values.emplace(statement.name, scad::evaluate(statement.arguments.front().value, scope, text_));
    }
  }

  /// The solids of a block in a scope of its own.
  bool combine_block(Operation operation, const std::vector<Statement>& statements, const Scope& outer,
                     const Affine3d& frame) {
    Scope scope{.outer = &outer};
    assign(statements, scope);
    return combine(operation, statements, scope, frame);
  }

  /// Whether there is a solid.
  bool combine(Operation operation, const std::vector<Statement>& statements, const Scope& scope,
               const Affine3d& frame) {
    std::vector<const Statement*> solids;
    for (const Statement& statement : statements) {
      const bool is_solid = statement.kind != Kind::assignment && statement.kind != Kind::module_definition;
      if (statement.is_shown && is_solid) solids.push_back(&statement);
    }
    return join(operation, solids.size(), [&](std::size_t i) { return add(*solids[i], scope, frame); });
  }

  /// What `add_one` adds, combined. Whether there is a solid.
  template <class AddOne>
  bool join(Operation operation, std::size_t count, const AddOne& add_one) {
    const std::size_t begin = postfix_.size();
    bool is_solid = false;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_added = add_one(i);
      if (is_added && is_solid) {
        postfix_.push_back(CsgNode::inner(operation, static_cast<std::uint32_t>(postfix_.size() - begin + 1)));
      } else if (i == 0 || operation == Operation::union_of) {
        is_solid = is_solid || is_added;
      } else if (!is_solid || operation == Operation::intersection) {
        is_solid = false;  // nothing less something, nothing and something
        postfix_.erase(postfix_.begin() + static_cast<std::ptrdiff_t>(begin), postfix_.end());
      }
    }
    return is_solid;
  }

  bool add(const Statement& statement, const Scope& scope, const Affine3d& frame) {
    const Level level(*this, statement);
    return statement.kind == Kind::block ? combine_block(Operation::union_of, statement.children, scope, frame)
                                         : call(statement, scope, frame);
  }

  bool call(const Statement& call, const Scope& scope, const Affine3d& frame) {
    if (const auto module = modules_.find(call.name); module != modules_.end()) {
      return call_module(*module->second, call, frame);
    }
    if (call.name == "difference") return combine_block(Operation::difference, call.children, scope, frame);
    if (call.name == "intersection") return combine_block(Operation::intersection, call.children, scope, frame);
    if (is_plain_union(call.name)) return combine_block(Operation::union_of, call.children, scope, frame);
    if (call.name == "for") return repeat(Operation::union_of, call, 0, scope, frame);
    if (call.name == "intersection_for") return repeat(Operation::intersection, call, 0, scope, frame);
    if (call.name == "rotate_extrude") return add_torus(call, scope, frame);
    if (const auto map = scad::transform_of(call, scope, text_)) {
      return combine_block(Operation::union_of, call.children, scope, frame * *map);
    }
    const auto leaf = scad::leaf_solid(call, scope, text_);
    if (!leaf) refuse_call(call);
    add_leaf(leaf->shape, call, frame * leaf->frame);
    return true;
  }

  /// The turns of a loop combined, of all variables from the given one on.
  bool repeat(Operation operation, const Statement& loop, std::size_t variable, const Scope& outer,
              const Affine3d& frame) {
    const Level level(*this, loop);
    if (variable == loop.arguments.size()) return combine_block(Operation::union_of, loop.children, outer, frame);
    const scad::Argument& argument = loop.arguments[variable];
    if (argument.name.empty()) {
      scad::refuse(text_, argument.value.offset, "expected a variable and its values, as in for (i = [0 : 3])");
    }
    std::vector<scad::Value> turns = scad::turns_of(scad::evaluate(argument.value, outer, text_), k_most_calls, text_);
    return join(operation, turns.size(), [&](std::size_t i) {
      Scope scope{.outer = &outer};
      scope.values.emplace(argument.name, std::move(turns[i]));
      return repeat(operation, loop, variable + 1, scope, frame);
    });
  }

  [[noreturn]] void refuse_call(const Statement& call) const {
    const bool is_foreign = std::ranges::find(k_no_solids, call.name) != k_no_solids.end();
    scad::refuse(
        text_, call.offset,
        fmt::format("expected a solid, a transformation, union, difference or intersection, found '{}'", call.name),
        is_foreign ? "write a mesh, openscad -o part.stl FILE.scad, and extract the tree from that" : scad::k_flatten);
  }

  bool call_module(const Statement& module, const Statement& call, const Affine3d& frame) {
    if (!call.arguments.empty() || !call.children.empty()) {
      scad::refuse(text_, call.offset, fmt::format("expected '{}();', found arguments or children", call.name),
                   scad::k_flatten);
    }
    const std::size_t before = primitives_.size();
    const bool is_added = combine_block(Operation::union_of, module.children, globals_, frame);
    if (primitives_.size() == before + 1) primitives_.back().id = module.name;
    return is_added;
  }

  /// A flat shape, and where it is.
  struct Profile {
    const Statement* shape;
    Affine3d map = Affine3d::Identity();

    [[nodiscard]] bool is_moved_only() const { return map.linear().isIdentity(1e-9) && map.translation().z() == 0.0; }
  };

  /// What the maps go to that a statement begins with.
  [[nodiscard]] Profile profile_of(const Statement& statement, const Affine3d& frame, const Scope& scope) const {
    Profile profile{.shape = &statement, .map = frame};
    while (profile.shape->children.size() == 1) {
      const auto map = scad::transform_of(*profile.shape, scope, text_);
      if (!map && profile.shape->kind != Kind::block && !is_plain_union(profile.shape->name)) break;
      if (map) profile.map = profile.map * *map;
      profile.shape = profile.shape->children.data();
    }
    return profile;
  }

  /// Whether a square leaves all of a circle but what is next to the axis, where no solid can be without a hole.
  [[nodiscard]] bool leaves_pinhole(const Profile& square, const Vector3d& centre, double radius,
                                    const Scope& scope) const {
    constexpr double k_widest = 0.1;  // of the circle's radius, more or less; what is missing goes with its power 5/2
    constexpr double k_rounding = 1e-6;
    if (square.shape->name != "square" || !square.is_moved_only()) return false;
    const Eigen::Vector2d size = scad::square_size(*square.shape, scope, text_);
    const Vector3d from = square.map.translation();
    const double left = centre.x() - radius;
    const double slack = k_rounding * radius;
    return from.x() - left <= k_widest * radius + slack && from.x() + size.x() >= centre.x() + radius - slack &&
           from.y() <= centre.y() - radius + slack && from.y() + size.y() >= centre.y() + radius - slack;
  }

  /// A circle beside the axis, turned around it.
  bool add_torus(const Statement& call, const Scope& scope, const Affine3d& frame) {
    constexpr std::array<std::string_view, 3> k_order{"angle", "convexity", "start"};
    const scad::Arguments arguments(call, k_order, {}, scope, text_);
    if (call.children.size() != 1 || arguments.number("angle").value_or(360) != 360) refuse_profile(call);
    Profile circle = profile_of(call.children.front(), Affine3d::Identity(), scope);
    std::optional<Profile> cut;
    if (circle.shape->name == "intersection" && circle.shape->children.size() == 2) {
      cut = profile_of(circle.shape->children.back(), circle.map, scope);
      circle = profile_of(circle.shape->children.front(), circle.map, scope);
    }
    if (circle.shape->name != "circle" || !circle.is_moved_only()) refuse_profile(call);
    const double radius = scad::round_radius(*circle.shape, scope, text_);
    const Vector3d centre = circle.map.translation();
    if (cut && !leaves_pinhole(*cut, centre, radius, scope)) refuse_profile(call);
    if (centre.x() < radius) {
      scad::refuse(text_, call.offset, "expected a circle that is wholly to the right of the axis");
    }
    const Eigen::Translation3d up(0, 0, centre.y());
    add_leaf(Torus{.major_radius = centre.x(), .minor_radius = radius}, call, frame * up);
    return true;
  }

  [[noreturn]] void refuse_profile(const Statement& call) const {
    scad::refuse(text_, call.offset, "expected a circle that is moved, and turned around wholly: a torus",
                 "write a mesh, openscad -o part.stl FILE.scad, and extract the tree from that");
  }

  /// A solid that is there already is the same primitive again.
  void add_leaf(const Shape& shape, const Statement& call, const Affine3d& frame) {
    auto placed = scad::place_solid(shape, frame);
    if (const auto* misfit = std::get_if<scad::Misfit>(&placed)) {
      scad::refuse(text_, call.offset, misfit->expected,
                   "write a mesh, openscad -o part.stl FILE.scad, and extract the tree from that");
    }
    auto& primitive = std::get<Primitive>(placed);
    primitive.id = call.name == "rotate_extrude" ? "torus" : call.name;
    try {
      validate(primitive);
    } catch (const Error& error) {
      scad::refuse(text_, call.offset, error.parts().where + ": " + error.parts().expected, error.parts().remedy);
    }
    const auto index = static_cast<PrimitiveIndex>(primitives_.size());
    const auto [known, is_new] = index_of_.emplace(numbers_of(primitive), index);
    if (is_new) primitives_.push_back(std::move(primitive));
    postfix_.push_back(CsgNode::leaf(known->second));
  }

  /// The first of a name has it, the others have it with a number.
  void name_primitives() {
    std::map<std::string, std::size_t, std::less<>> count;
    for (const Primitive& primitive : primitives_) count.emplace(primitive.id, 0);
    for (Primitive& primitive : primitives_) {
      const std::string name = primitive.id;
      if (++count[name] == 1) continue;
      do {
        primitive.id = fmt::format("{}_{}", name, count[name]++);
      } while (count.contains(primitive.id));
      --count[name];
      count.emplace(primitive.id, 1);
    }
  }

  std::string_view text_;
  Scope globals_ = {};
  std::map<std::string, const Statement*, std::less<>> modules_ = {};
  PrimitiveSet primitives_ = {};
  std::map<std::vector<double>, PrimitiveIndex> index_of_ = {};
  std::vector<CsgNode> postfix_ = {};
  std::size_t level_ = 0;
  std::size_t calls_ = 0;
};

}  // namespace

Model parse_openscad(std::string_view text, const std::string& name) {
  try {
    Model model = Builder(text).build(scad::parse(text));
    model.description = "read from " + name;
    return model;
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    parts.file = name;
    throw Error(parts);
  }
}

}  // namespace cloud2csg
