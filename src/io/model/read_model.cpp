#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "core/base/text.hpp"
#include "io/formats/formats.hpp"
#include "io/model/schema_validator.hpp"
#include "io/model/tree_reader.hpp"
#include "io/openscad/read_openscad.hpp"

namespace cloud2csg {
namespace {

/// Deepest tree that is read, in levels of the file's n-ary tree.
constexpr int k_max_tree_depth = 10'000;

using nlohmann::json;

// Each level of the tree is an object within a list. The rest of a model needs far fewer than the 16 spare levels.
constexpr std::size_t k_max_nesting = 2 * k_max_tree_depth + 16;
constexpr std::size_t k_longest_reason = 80;

std::string place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

/// The reason in the JSON library's words. Removes its head "[json.exception...] parse error at line 1, column 2:
/// syntax error while parsing value - " and, if not printable or too long, its tail "; last read: '...'".
std::string reason_of(const json::exception& exception) {
  std::string reason = exception.what();
  for (const char* end_of_head : {": ", " - "}) {
    if (const std::size_t head = reason.find(end_of_head); head != std::string::npos) reason.erase(0, head + 2);
  }
  const bool is_plain = std::all_of(reason.begin(), reason.end(), [](char c) { return c >= ' ' && c <= '~'; });
  const std::size_t tail = reason.find("; last read: ");
  if (tail != std::string::npos && (!is_plain || reason.size() > k_longest_reason)) reason.erase(tail);
  return reason.substr(reason.find_first_not_of(' '), k_longest_reason);
}

[[noreturn]] void refuse_text(std::string_view text, std::size_t byte, const std::string& reason) {
  throw Error({.where = place_of(text, byte),
               .expected = fmt::format("expected JSON, found an error in it: {}", reason),
               .remedy = "correct the text there"});
}

/// Checks a text before parsing: its syntax, and faults that JSON allows: numbers beyond double, duplicate fields,
/// bottomless nesting. (The library's own callback takes time quadratic in the length of lists.)
class ParseGuard : public nlohmann::json_sax<json> {
 public:
  explicit ParseGuard(std::string_view text) : text_(text) {}

  bool null() override { return finish_value(); }
  bool boolean(bool /*value*/) override { return finish_value(); }
  bool number_integer(number_integer_t /*value*/) override { return finish_value(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return finish_value(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return finish_value(); }
  bool string(string_t& /*value*/) override { return finish_value(); }
  bool binary(binary_t& /*value*/) override { return finish_value(); }
  bool start_object(std::size_t /*size*/) override { return open(false); }
  bool start_array(std::size_t /*size*/) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override { return add_field(name); }
  bool parse_error(std::size_t byte, const std::string& last_word, const json::exception& error) override {
    constexpr int k_no_double = 406;
    if (error.id != k_no_double) refuse_text(text_, byte, reason_of(error));
    throw Error({.where = path(),
                 .expected = fmt::format("expected a number that fits a double, found {}",
                                         visible_text(last_word, k_longest_quote)),
                 .remedy = "numbers go up to about 1.8e308"});
  }

 private:
  [[nodiscard]] std::string path() const {
    json::json_pointer pointer;
    for (const Level& level : levels_) {
      if (level.is_list) {
        pointer.push_back(std::to_string(level.index));
      } else if (!level.field.empty()) {
        pointer.push_back(level.field);
      }
    }
    return pointer.to_string();
  }

  /// An open object or list, with the index or name of its current value.
  struct Level {
    bool is_list;
    std::size_t index = 0;
    std::string field = {};
    std::set<std::string> fields = {};
  };

  bool open(bool is_list) {
    if (levels_.size() >= k_max_nesting) {
      throw Error({.where = levels_.front().is_list ? "" : "/" + levels_.front().field,
                   .expected = fmt::format("nested too deeply: a tree may have {} levels", k_max_tree_depth),
                   .remedy = "write nested unions as one union of many children, and so for intersections"});
    }
    levels_.push_back({.is_list = is_list});
    return true;
  }

  bool close() {
    levels_.pop_back();
    return finish_value();
  }

  bool finish_value() {
    if (!levels_.empty() && levels_.back().is_list) ++levels_.back().index;
    return true;
  }

  bool add_field(const std::string& name) {
    Level& object = levels_.back();
    object.field = name;
    if (object.fields.insert(name).second) return true;
    throw Error({.where = path(),
                 .expected = "expected each field of an object once, found this one twice",
                 .remedy = "remove one of the two"});
  }

  std::string_view text_;
  std::vector<Level> levels_ = {};
};

/// Parses JSON. @throws Error with line and column (in bytes) for a syntax error; with the path of the field for a
/// duplicate field, a number that no double holds, or nesting too deep for k_max_tree_depth. The error names no file.
json parse_json(std::string_view text) {
  // The JSON library stops at a zero byte.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    refuse_text(text, nul + 1, "a byte of value 0");
  }
  ParseGuard guard(text);
  json::sax_parse(text, &guard);
  return json::parse(text);
}

using nlohmann::json;

constexpr double k_unit_tolerance = 1e-6;
// Double precision cannot tell a smaller error from unit length. Rescaling would change the last bits at each reading.
constexpr double k_unit_rounding = 1e-15;

Eigen::Vector3d vector_of(const json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

/// The factor to unit length. @throws Error if the length differs from 1 by more than rounding explains.
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

Profile profile_of(const json& value) {
  Profile profile;
  for (const json& corners : value["profile"]) {
    ClosedPath& path = profile.paths.emplace_back();
    for (const json& corner : corners) {
      path.push_back({.point = {corner[0].get<double>(), corner[1].get<double>()},
                      .bulge = corner.size() > 2 ? corner[2].get<double>() : 0.0});
    }
  }
  return profile;
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
  if (type == "extrusion") return Extrusion{.profile = profile_of(value), .height = number("height")};
  if (type == "revolution")
    return Revolution{.profile = profile_of(value), .angle_deg = value.value("angle_deg", 360.0)};
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
                     .expected = fmt::format("expected a unique id, found \"{}\" as in /primitives/{}",
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

  /// The type's name, which is also the name of its schema definition.
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
