#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/extract.hpp"
#include "command.hpp"
#include "core/base/text.hpp"

namespace cloud2csg::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoCommand {
  std::string file;
  bool is_json = false;

  void run() const;
};

/// Infinite coordinates become null, since JSON has no infinity.
Json to_json(const Eigen::Vector3d& vector) {
  Json list = Json::array();
  for (int axis = 0; axis < 3; ++axis) list.push_back(std::isfinite(vector[axis]) ? Json(vector[axis]) : Json());
  return list;
}

Json to_json(const AlignedBox& box) {
  return box.isEmpty() ? Json() : Json{to_json(box.min()), to_json(box.max())};
}

Json describe(const PointCloud& cloud) {
  return {{"kind", "cloud"},
          {"points", cloud.size()},
          {"normals", cloud.has_normals()},
          {"sensor_positions", cloud.has_sensor_positions()},
          {"bounds", to_json(bounds_of(cloud.positions))}};
}

Json describe(const TriangleMesh& mesh) {
  const bool watertight = is_watertight(mesh);
  return {{"kind", "mesh"},
          {"vertices", mesh.vertices.size()},
          {"triangles", mesh.triangles.size()},
          {"watertight", watertight},
          {"volume", watertight ? Json(volume_of(mesh)) : Json()},
          {"bounds", to_json(bounds_of(mesh.vertices))}};
}

AlignedBox bounds_of(const PrimitiveSet& primitives) {
  AlignedBox box;
  for (const Primitive& primitive : primitives) box.extend(bounds(primitive));
  return box;
}

Json describe(const CsgTree& tree, const PrimitiveSet& primitives) {
  const TreeStatistics statistics = statistics_of(tree, primitives);
  return {{"size", statistics.size},   {"leaves", statistics.leaves},
          {"price", statistics.price}, {"operations", statistics.operations},
          {"depth", statistics.depth}, {"text", to_text(tree, primitives)}};
}

Json describe(const Model& model) {
  std::map<std::string, std::size_t> by_type;
  for (const Primitive& primitive : model.primitives) {
    ++by_type[(primitive.displacement ? "displaced " : "") + std::string(type_name(primitive.shape))];
  }
  const AlignedBox box = model.tree ? bounds_of(model) : bounds_of(model.primitives);
  return {{"kind", "model"},
          {"description", model.description},
          {"primitives", model.primitives.size()},
          {"types", by_type},
          {"bounds", to_json(box)},
          {"tree", model.tree ? describe(*model.tree, model.primitives) : Json()}};
}

Json describe(const Shape3d& shape) {
  if (shape.model) return describe(*shape.model);
  if (shape.mesh) return describe(*shape.mesh);
  return describe(*shape.cloud);
}

std::string coordinates(const Json& point) {
  std::string text;
  for (const Json& value : point) {
    text +=
        (text.empty() ? "" : " ") + (value.is_null() ? std::string("inf") : fmt::format("{:.6g}", value.get<double>()));
  }
  return text;
}

std::string plain(const std::string& name, const Json& value) {
  if (value.is_null()) return "-";
  if (name == "bounds") return fmt::format("({}) to ({})", coordinates(value[0]), coordinates(value[1]));
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return visible_text(value.get<std::string>());
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  return value.dump();
}

/// One line per field, nested fields indented.
std::string to_table(const Json& fields, const std::string& indent) {
  std::string table;
  std::size_t width = 14 - indent.size();
  for (const auto& field : fields.items()) width = std::max(width, field.key().size());
  for (const auto& [name, value] : fields.items()) {
    if (value.is_object()) {
      table += fmt::format("{}{}\n{}", indent, name, to_table(value, indent + "  "));
    } else if (!(value.is_string() && value.get<std::string>().empty())) {
      table += fmt::format("{}{:<{}} {}\n", indent, name, width, plain(name, value));
    }
  }
  return table;
}

void InfoCommand::run() const {
  const Shape3d shape = read_shape(file);
  const Json fields = describe(shape);
  for (const std::string& warning : shape.model ? shape.model->warnings : std::vector<std::string>()) {
    fmt::print(stderr, "warning: {}\n", visible_text(warning));
  }
  if (is_json) {
    fmt::print("{}\n", fields.dump(2));
  } else {
    fmt::print("{}", to_table(fields, ""));
  }
}

}  // namespace

Command add_info(CLI::App& program) {
  CLI::App* app = program.add_subcommand("info", "Describes the contents of a cloud, mesh or model file");
  app->footer(example("  cloud2csg info bracket.json"));
  auto command = std::make_shared<InfoCommand>();
  add_file(*app, "file", command->file, "Point cloud, mesh or model")->type_name("FILE");
  app->add_flag("--json", command->is_json, "Print JSON instead of a table")->group("Output");
  return {.options = app, .run = [command](const std::stop_token& /*stop*/) {
            command->run();
            return k_done;
          }};
}

}  // namespace cloud2csg::app
