#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "core/primitive/shape.hpp"

// Not by nlohmann's dump(), which recurses as deep as the tree. One primitive or leaf a line is easy to edit.
namespace cloud2csg {
namespace {

// Limits indentation, so that a long chain does not grow quadratically.
constexpr std::size_t k_deepest_indent = 40;

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Shortest text that reads back as the same doubles.
std::string list(std::initializer_list<double> numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ", "));
}
std::string list(const Eigen::Vector3d& v) {
  return list({v.x(), v.y(), v.z()});
}

std::string fields_of(const Box& box) {
  return fmt::format(R"("size": {})", list(box.size));
}
std::string fields_of(const Sphere& sphere) {
  return fmt::format(R"("radius": {})", sphere.radius);
}
std::string fields_of(const Cylinder& cylinder) {
  return fmt::format(R"("radius": {}, "height": {})", cylinder.radius, cylinder.height);
}
std::string fields_of(const Cone& cone) {
  return fmt::format(R"("radius_bottom": {}, "radius_top": {}, "height": {})", cone.radius_bottom, cone.radius_top,
                     cone.height);
}
std::string fields_of(const Torus& torus) {
  return fmt::format(R"("major_radius": {}, "minor_radius": {})", torus.major_radius, torus.minor_radius);
}
std::string fields_of(const HalfSpace& /*half_space*/) {
  return {};
}
std::string fields_of(const Polytope& polytope) {
  std::vector<std::string> planes;
  for (const Plane& plane : polytope.planes) {
    planes.push_back(list({plane.normal.x(), plane.normal.y(), plane.normal.z(), plane.offset}));
  }
  return fmt::format(R"("planes": [{}])", fmt::join(planes, ", "));
}
std::string text_of(const Profile& profile) {
  std::vector<std::string> paths;
  for (const ClosedPath& path : profile.paths) {
    std::vector<std::string> corners;
    for (const PathCorner& corner : path) {
      corners.push_back(corner.bulge == 0 ? list({corner.point.x(), corner.point.y()})
                                          : list({corner.point.x(), corner.point.y(), corner.bulge}));
    }
    paths.push_back(fmt::format("[{}]", fmt::join(corners, ", ")));
  }
  return fmt::format(R"("profile": [{}])", fmt::join(paths, ", "));
}
std::string fields_of(const Extrusion& extrusion) {
  return fmt::format(R"({}, "height": {})", text_of(extrusion.profile), extrusion.height);
}
std::string fields_of(const Revolution& revolution) {
  if (is_full_turn(revolution)) return text_of(revolution.profile);
  return fmt::format(R"({}, "angle_deg": {})", text_of(revolution.profile), revolution.angle_deg);
}
std::string fields_of(const Expression& expression) {
  return fmt::format(R"("distance": {}, "bounds": [{}, {}])", quoted(expression.distance),
                     list(expression.bounds.min()), list(expression.bounds.max()));
}

std::string line_of(const Primitive& primitive) {
  const Eigen::Quaterniond& q = primitive.pose.orientation;
  std::string line =
      fmt::format(R"({{"id": {}, "type": "{}", "pose": {{"position": {}, "quaternion": {}}})", quoted(primitive.id),
                  type_name(primitive.shape), list(primitive.pose.position), list({q.w(), q.x(), q.y(), q.z()}));
  const std::string fields = std::visit([](const auto& shape) { return fields_of(shape); }, primitive.shape);
  if (!fields.empty()) line += ", " + fields;
  if (primitive.displacement) {
    line += fmt::format(R"(, "displacement": {{"frequency": {}}})", primitive.displacement->frequency);
  }
  if (primitive.evidence) {
    line += fmt::format(R"(, "evidence": {{"points": {}, "rms": {}}})", primitive.evidence->points,
                        primitive.evidence->rms);
  }
  return line + "}";
}

/// The operands of a chain, from left to right: the topmost subtrees below `node` with another operation.
std::vector<std::size_t> operands(const CsgTree& tree, std::size_t node) {
  const Operation operation = tree.nodes()[node].operation();
  if (operation == Operation::complement) return {node - 1};
  if (operation == Operation::difference) return {tree.first_child(node), tree.second_child(node)};
  std::vector<std::size_t> found;
  std::vector<std::size_t> pending{node};
  while (!pending.empty()) {
    const std::size_t next = pending.back();
    pending.pop_back();
    if (tree.nodes()[next].operation() != operation) {
      found.push_back(next);
      continue;
    }
    pending.push_back(tree.second_child(next));
    pending.push_back(tree.first_child(next));
  }
  return found;
}

std::string tree_text(const CsgTree& tree, const PrimitiveSet& primitives) {
  struct UnfinishedNode {
    std::vector<std::size_t> operands;
    std::size_t done = 0;
  };
  std::string text;
  std::vector<UnfinishedNode> open;
  const auto write = [&](std::size_t node) {
    const CsgNode head = tree.nodes()[node];
    if (head.operation() == Operation::primitive) {
      text += fmt::format(R"({{"primitive": {}}})", quoted(primitives[head.primitive()].id));
    } else if (head.is_leaf()) {
      text += fmt::format(R"({{"op": "{}"}})", to_string(head.operation()));
    } else {
      text += fmt::format(R"({{"op": "{}", "children": [)", to_string(head.operation()));
      open.push_back({.operands = operands(tree, node)});
    }
  };
  write(tree.root());
  while (!open.empty()) {
    UnfinishedNode& node = open.back();
    if (node.done == node.operands.size()) {
      text += "]}";
      open.pop_back();
      continue;
    }
    text += node.done == 0 ? "\n" : ",\n";
    text.append(2 * std::min(open.size(), k_deepest_indent), ' ');
    write(node.operands[node.done++]);
  }
  return text;
}

/// Refuses to write a file that could not be read again.
void require_valid(const PrimitiveSet& primitives) {
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    try {
      validate(primitives[i]);
    } catch (const Error& error) {
      Error::Parts parts = error.parts();
      parts.where = fmt::format("/primitives/{}/{}", i, parts.where);
      throw Error(parts);
    }
  }
}

}  // namespace

std::string to_json(const Model& model) {
  require_valid(model.primitives);
  std::string text = "{\"format\": \"cloud2csg\", \"version\": 1,\n";
  if (!model.description.empty()) text += fmt::format(" \"description\": {},\n", quoted(model.description));
  text += R"( "primitives": [)";
  for (std::size_t i = 0; i < model.primitives.size(); ++i) {
    text += i == 0 ? "\n   " : ",\n   ";
    text += line_of(model.primitives[i]);
  }
  text += "]";
  if (model.tree) text += ",\n \"tree\": " + tree_text(*model.tree, model.primitives);
  return text + "}\n";
}

void write_model(const std::filesystem::path& file, const Model& model) {
  try {
    write_text_file(file, to_json(model));
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    parts.file = file.string();
    throw Error(parts);
  }
}

}  // namespace cloud2csg
