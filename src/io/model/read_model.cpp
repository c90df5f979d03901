#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "core/base/text.hpp"
#include "io/formats/formats.hpp"
#include "io/model/json_text.hpp"
#include "io/model/schema_message.hpp"
#include "io/model/schema_validator.hpp"
#include "io/model/tree_reader.hpp"
#include "io/openscad/read_openscad.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

constexpr double k_unit_tolerance = 1e-6;
// Below this a length is 1 as well as doubles can say; scaling again would only change the last bits at every reading.
constexpr double k_unit_rounding = 1e-15;

Eigen::Vector3d vector_of(const json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

/// What a direction must be multiplied with to have unit length.
/// @throws Error when it is further from unit length than rounding explains.
double unit_scale(double length, const std::string& where) {
  if (!(std::abs(length - 1.0) <= k_unit_tolerance)) {
    throw Error({.where = where,
                 .expected = fmt::format("expected unit length, found a length of {:.9g}", length),
                 .remedy = "divide by the length"});
  }
  return std::abs(length - 1.0) <= k_unit_rounding ? 1.0 : 1.0 / length;
}

Pose pose_of(const json& primitive, const std::string& where) {
  Pose pose;
  const auto found = primitive.find("pose");
  if (found == primitive.end()) return pose;
  if (found->contains("position")) pose.position = vector_of((*found)["position"]);
  if (found->contains("quaternion")) {
    const json& q = (*found)["quaternion"];
    pose.orientation = {q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()};
    pose.orientation.coeffs() *= unit_scale(pose.orientation.norm(), where + "/pose/quaternion");
  }
  return pose;
}

Polytope polytope_of(const json& value, const std::string& where) {
  Polytope polytope;
  for (const json& plane : value["planes"]) {
    const Eigen::Vector3d normal = vector_of(plane);
    const double scale = unit_scale(normal.norm(), fmt::format("{}/planes/{}", where, polytope.planes.size()));
    polytope.planes.push_back({.normal = scale * normal, .offset = scale * plane[3].get<double>()});
  }
  return polytope;
}

Shape shape_of(const json& value, const std::string& type, const std::string& where) {
  const auto number = [&value](const char* field) { return value[field].get<double>(); };
  if (type == "box") return Box{.size = vector_of(value["size"])};
  if (type == "sphere") return Sphere{.radius = number("radius")};
  if (type == "cylinder") return Cylinder{.radius = number("radius"), .height = number("height")};
  if (type == "cone") {
    return Cone{
        .radius_bottom = number("radius_bottom"), .radius_top = number("radius_top"), .height = number("height")};
  }
  if (type == "torus") return Torus{.major_radius = number("major_radius"), .minor_radius = number("minor_radius")};
  if (type == "half_space") return HalfSpace{};
  if (type == "polytope") return polytope_of(value, where);
  const json& bounds = value["bounds"];
  return Expression{.distance = value["distance"].get<std::string>(),
                    .bounds = AlignedBox(vector_of(bounds[0]), vector_of(bounds[1]))};
}

class ModelReader {
 public:
  ModelReader() : schema_(json::parse(model_schema())), validator_(schema_) {}

  Model read(const json& document) {
    require("model", document, "");
    Model model;
    model.description = document.value("description", std::string());
    std::map<std::string, PrimitiveIndex, std::less<>> index_of_id;
    for (const json& value : document["primitives"]) {
      const std::string where = fmt::format("/primitives/{}", model.primitives.size());
      Primitive primitive = read_primitive(value, where);
      const auto index = static_cast<PrimitiveIndex>(model.primitives.size());
      if (const auto [first, fresh] = index_of_id.emplace(primitive.id, index); !fresh) {
        throw Error({.where = where + "/id",
                     .expected = fmt::format("expected an id of its own, found \"{}\" as in /primitives/{}",
                                             visible_text(primitive.id, k_longest_quote), first->second)});
      }
      model.primitives.push_back(std::move(primitive));
    }
    if (document.contains("tree")) {
      const auto check = [this](const char* definition, const json& node) { require(definition, node, ""); };
      model.tree = read_tree(document["tree"], index_of_id, check);
    }
    return model;
  }

 private:
  void require(const std::string& definition, const json& value, const std::string& where) const {
    const std::vector<FieldPath> violations = validator_.violations(definition, value);
    if (!violations.empty()) throw Error(explain_violation(schema_, definition, value, violations, where));
  }

  /// The type's name, which is that of its definition too.
  std::string type_of(const json& value, const std::string& where) const {
    std::vector<std::string> types;
    for (const json& definition : schema_["definitions"]["primitive"]["oneOf"]) {
      const auto reference = definition["$ref"].get<std::string>();
      types.push_back(reference.substr(reference.rfind('/') + 1));
    }
    const json type = value.is_object() ? value.value("type", json()) : json();
    for (const std::string& known : types) {
      if (type == known) return known;
    }
    throw Error({.where = value.is_object() ? where + "/type" : where,
                 .expected = !value.is_object() ? fmt::format("expected a primitive, found {}", brief(value))
                             : value.contains("type")
                                 ? fmt::format("expected one of {}, found {}", fmt::join(types, ", "), brief(type))
                                 : fmt::format("expected one of {}, found nothing", fmt::join(types, ", "))});
  }

  Primitive read_primitive(const json& value, const std::string& where) const {
    const std::string type = type_of(value, where);
    require(type, value, where);
    Primitive primitive{.id = value["id"].get<std::string>(),
                        .shape = shape_of(value, type, where),
                        .pose = pose_of(value, where),
                        .displacement = {},
                        .evidence = {}};
    if (value.contains("displacement")) {
      primitive.displacement = Displacement{.frequency = value["displacement"]["frequency"].get<double>()};
    }
    if (const auto found = value.find("evidence"); found != value.end()) {
      primitive.evidence =
          Evidence{.points = (*found)["points"].get<std::size_t>(), .rms = (*found)["rms"].get<double>()};
    }
    try {
      validate(primitive);
    } catch (const Error& error) {
      Error::Parts parts = error.parts();
      parts.where = parts.where.empty() ? where : where + "/" + parts.where;
      throw Error(parts);
    }
    return primitive;
  }

  json schema_;
  SchemaValidator validator_;
};

}  // namespace

Model parse_model(std::string_view json, const std::string& name) {
  try {
    return ModelReader().read(parse_json(json));
  } catch (const Error& error) {
    Error::Parts parts = error.parts();
    parts.file = name;
    throw Error(parts);
  }
}

Model read_model(const std::filesystem::path& file) {
  switch (format_to_read(file, {FileKind::model}).format) {
    case FileFormat::Id::scad:
      return read_openscad(file);
    case FileFormat::Id::csg:
      return parse_openscad(read_text_file(file), file.string());
    default:
      return parse_model(read_text_file(file), file.string());
  }
}

}  // namespace cloud2csg
