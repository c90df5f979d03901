#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/text.hpp"
#include "io/clouds/text_rows.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"
#include "io/meshes/zip_archive.hpp"

namespace cloud2csg {
namespace {

/// Text of 3D models compresses 5 to 20 times. A hundred times this ratio needs a crafted archive.
constexpr std::size_t k_most_packing = 100;
constexpr std::size_t k_least_limit = std::size_t{1} << 26U;
/// Seven million triangles. The mesh made from the text needs six times its memory.
constexpr std::size_t k_most_text = std::size_t{1} << 29U;

/// Lengths in millimetres.
constexpr std::array<std::pair<std::string_view, double>, 6> k_units{
    {{"micron", 0.001}, {"millimeter", 1.0}, {"centimeter", 10.0}, {"inch", 25.4}, {"foot", 304.8}, {"meter", 1000.0}}};

class ThreeMfReader {
 public:
  explicit ThreeMfReader(const FileContent& content) : content_(content), assembly_(content) {}

  TriangleMesh read() {
    const pugi::xml_document document = load(model_name());
    const pugi::xml_node model = document.child("model");
    for (const pugi::xml_node object : model.child("resources").children("object")) {
      if (!objects_.emplace(object.attribute("id").value(), object).second) fail(object, "id", "a unique id");
    }
    place(model.child("build"), "item", Eigen::Affine3d(Eigen::Scaling(unit_of(model))), 0);
    return std::move(assembly_).finish();
  }

 private:
  [[noreturn]] void fail(const pugi::xml_node& node, const char* attribute, std::string_view expected) const {
    content_.fail(fmt::format("expected {} as {} of {}, found \"{}\"", expected, attribute, node.name(),
                              visible_text(node.attribute(attribute).value(), k_longest_quote)));
  }

  [[nodiscard]] std::string model_name() const {
    const pugi::xml_document relations = load("_rels/.rels");
    for (const pugi::xml_node relation : relations.child("Relationships").children("Relationship")) {
      const std::string_view type = relation.attribute("Type").value();
      const std::string_view target = relation.attribute("Target").value();
      if (type.ends_with("/3dmodel")) return std::string(target.substr(target.starts_with('/') ? 1 : 0));
    }
    content_.fail("expected a 3D model in the archive, found none", "is it a .3mf file?");
  }

  [[nodiscard]] pugi::xml_document load(const std::string& name) const {
    const std::string text =
        unzip_entry(content_, name, std::min(k_most_text, k_least_limit + k_most_packing * content_.bytes().size()));
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
    if (!result) {
      content_.fail(fmt::format("expected XML as {}, found an error at its byte {}: {}",
                                visible_text(name, k_longest_quote), result.offset, result.description()));
    }
    return document;
  }

  [[nodiscard]] double unit_of(const pugi::xml_node& model) const {
    const std::string_view name = model.attribute("unit").as_string("millimeter");
    const auto* const unit = std::ranges::find(k_units, name, &std::pair<std::string_view, double>::first);
    if (unit == k_units.end()) fail(model, "unit", "micron, millimeter, centimeter, inch, foot or meter");
    return unit->second;
  }

  [[nodiscard]] double number(const pugi::xml_node& node, const char* attribute) const {
    const std::optional<double> number = parse_number(node.attribute(attribute).value());
    if (!number) fail(node, attribute, "a number");
    return *number;
  }

  /// Places the objects that items or components name.
  void place(const pugi::xml_node& parent, const char* name, const Eigen::Affine3d& outer, std::size_t level) {
    for (const pugi::xml_node node : parent.children(name)) {
      const auto object = objects_.find(node.attribute("objectid").value());
      if (object == objects_.end()) fail(node, "objectid", "the id of an object");
      if (level == k_most_levels) fail(node, "objectid", "an object that does not contain itself");
      const Eigen::Affine3d motion = outer * motion_of(node);
      assembly_.start_part(motion);
      add_mesh(object->second.child("mesh"));
      place(object->second.child("components"), "component", motion, level + 1);
    }
  }

  void add_mesh(const pugi::xml_node& mesh) {
    for (const pugi::xml_node v : mesh.child("vertices").children("vertex")) {
      assembly_.add_vertex(std::array{number(v, "x"), number(v, "y"), number(v, "z")},
                           {FilePosition::Unit::vertex, assembly_.vertex_count()});
    }
    std::size_t count = 0;
    for (const pugi::xml_node t : mesh.child("triangles").children("triangle")) {
      assembly_.add_polygon(std::array{number(t, "v1"), number(t, "v2"), number(t, "v3")},
                            {FilePosition::Unit::triangle, count++});
    }
  }

  /// Twelve numbers: the columns of the affine map, the last column being the translation.
  [[nodiscard]] Eigen::Affine3d motion_of(const pugi::xml_node& node) const {
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    const pugi::xml_attribute attribute = node.attribute("transform");
    if (!attribute) return motion;
    const std::vector<std::string> words = split_words(attribute.value());
    if (words.size() != 12) fail(node, "transform", "12 numbers");
    for (Eigen::Index i = 0; i < 12; ++i) {
      const std::optional<double> number = parse_number(words[static_cast<std::size_t>(i)]);
      if (!number) fail(node, "transform", "12 numbers");
      motion(i % 3, i / 3) = *number;
    }
    return motion;
  }

  const FileContent& content_;
  MeshAssembly assembly_;
  std::map<std::string_view, pugi::xml_node> objects_ = {};
};

}  // namespace

TriangleMesh read_3mf(const FileContent& content) {
  return ThreeMfReader(content).read();
}

}  // namespace cloud2csg
