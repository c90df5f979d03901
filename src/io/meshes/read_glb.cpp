#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/clouds/scalar_type.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"
#include "io/meshes/placed_parts.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

/// The two chunks of a file: what there is, and its numbers.
struct GlbChunks {
  std::string_view text = {};
  std::string_view numbers = {};
};

GlbChunks split_glb(const FileContent& content) {
  constexpr std::size_t k_word = sizeof(std::uint32_t);
  constexpr std::size_t k_head = 3 * k_word;
  constexpr std::uint32_t k_text_chunk = 0x4E4F534A;
  constexpr std::uint32_t k_number_chunk = 0x004E4942;
  const std::string_view bytes = content.bytes();
  const auto word = [&](std::size_t at) { return load<std::uint32_t>(bytes.data() + at, std::endian::little); };
  if (bytes.size() < k_head || !bytes.starts_with("glTF") || word(k_word) != 2) {
    content.fail("expected binary glTF 2.0", "is it a .glb file?");
  }
  GlbChunks chunks;
  for (std::size_t begin = k_head; bytes.size() - begin >= 2 * k_word;) {
    const std::size_t length = word(begin);
    const std::uint32_t kind = word(begin + k_word);
    begin += 2 * k_word;
    if (length > bytes.size() - begin) {
      content.fail({FilePosition::Unit::byte, begin}, "the file ends within a chunk", k_copy_again);
    }
    if (kind == k_text_chunk && chunks.text.empty()) chunks.text = bytes.substr(begin, length);
    if (kind == k_number_chunk && chunks.numbers.empty()) chunks.numbers = bytes.substr(begin, length);
    begin += length;
  }
  return chunks;
}

/// Numbers in the file: `count` groups of some, `stride` bytes from one to the next.
struct GlbView {
  const char* base;
  std::size_t count;
  std::size_t stride;
  ScalarType type;

  [[nodiscard]] double number(std::size_t group, std::size_t component) const {
    return decode(base + group * stride + component * size_of(type), type, std::endian::little);
  }
};

class GlbReader {
 public:
  explicit GlbReader(const FileContent& content)
      : content_(content),
        chunks_(split_glb(content)),
        document_(json::parse(chunks_.text, nullptr, false)),
        size_(content) {}

  TriangleMesh read() {
    if (!document_.is_object()) content_.fail("expected JSON in the first chunk, found none, or an error in it");
    // A part a node, then one a mesh.
    const json& nodes = list(document_, "nodes");
    std::vector<MeshPart> parts(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      parts[i].children = placed_nodes(list(nodes[i], "children"));
      if (!nodes[i].contains("mesh")) continue;
      const std::size_t mesh = whole(nodes[i], "mesh");
      (void)item("meshes", mesh);
      parts[i].children.push_back({.part = nodes.size() + mesh});
    }
    for (const json& mesh : list(document_, "meshes")) {
      MeshAssembly assembly(content_);
      for (const json& primitive : list(mesh, "primitives")) add_primitive(assembly, primitive);
      parts.push_back({.mesh = std::move(assembly).finish()});
    }
    return place_parts(content_, parts, placed_nodes(list(item("scenes", whole(document_, "scene", 0)), "nodes")));
  }

 private:
  [[noreturn]] void fail(std::string_view expected, std::string_view field, const json& found) const {
    content_.fail(fmt::format("expected {} as \"{}\", found {}", expected, field,
                              found.is_number() ? found.dump() : found.type_name()));
  }

  [[nodiscard]] static const json& member(const json& object, const char* field) {
    static const json k_none;
    const auto found = object.find(field);
    return found == object.end() ? k_none : *found;
  }

  /// Empty when it is not there.
  [[nodiscard]] const json& list(const json& object, const char* field) const {
    static const json k_none = json::array();
    const json& found = member(object, field);
    if (!found.is_array() && !found.is_null()) fail("a list", field, found);
    return found.is_array() ? found : k_none;
  }

  [[nodiscard]] const json& item(const char* field, std::size_t index) const {
    const json& items = list(document_, field);
    if (index >= items.size()) {
      content_.fail(fmt::format("expected an entry {} of \"{}\", found {} of them", index, field, items.size()));
    }
    return items[index];
  }

  /// What an index, a size or a count can be: so small that products do not overflow.
  [[nodiscard]] std::size_t whole_number(const json& value, const char* field) const {
    constexpr std::uint64_t k_most = std::numeric_limits<std::uint32_t>::max();
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > k_most) fail("a whole number", field, value);
    return value.get<std::size_t>();
  }
  [[nodiscard]] std::size_t whole(const json& object, const char* field) const {
    return whole_number(member(object, field), field);
  }
  [[nodiscard]] std::size_t whole(const json& object, const char* field, std::size_t otherwise) const {
    return object.contains(field) ? whole(object, field) : otherwise;
  }

  template <std::size_t count>
  [[nodiscard]] std::optional<std::array<double, count>> numbers(const json& object, const char* field) const {
    const json& values = list(object, field);
    if (values.empty()) return std::nullopt;
    std::array<double, count> numbers{};
    for (std::size_t i = 0; i < count; ++i) {
      if (values.size() != count || !values[i].is_number()) fail(fmt::format("{} numbers", count), field, values);
      numbers[i] = values[i].template get<double>();
    }
    return numbers;
  }

  [[nodiscard]] std::vector<MeshPart::Child> placed_nodes(const json& indices) const {
    std::vector<MeshPart::Child> nodes;
    for (const json& index : indices) {
      const std::size_t node = whole_number(index, "nodes");
      nodes.push_back({.part = node, .motion = motion_of(item("nodes", node))});
    }
    return nodes;
  }

  [[nodiscard]] Eigen::Affine3d motion_of(const json& node) const {
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    if (const auto matrix = numbers<16>(node, "matrix")) {
      motion.affine() = Eigen::Map<const Eigen::Matrix4d>(matrix->data()).topRows<3>();
    }
    if (const auto t = numbers<3>(node, "translation")) motion.translate(Eigen::Vector3d(t->data()));
    if (const auto q = numbers<4>(node, "rotation")) motion.rotate(Eigen::Quaterniond(q->data()).normalized());
    if (const auto s = numbers<3>(node, "scale")) motion.scale(Eigen::Vector3d(s->data()));
    return motion;
  }

  void add_primitive(MeshAssembly& assembly, const json& primitive) {
    constexpr std::size_t k_triangles = 4;
    constexpr std::size_t k_strip = 5;
    constexpr std::size_t k_fan = 6;
    const std::size_t mode = whole(primitive, "mode", k_triangles);
    if (mode < k_triangles) return;  // points or lines
    const std::size_t first = assembly.vertex_count();
    const GlbView places = view_of(whole(member(primitive, "attributes"), "POSITION"), "VEC3", 3);
    if (places.type != ScalarType::float32) content_.fail("expected positions in single precision, found others");
    for (std::size_t i = 0; i < places.count; ++i) {
      assembly.add_vertex(std::array{places.number(i, 0), places.number(i, 1), places.number(i, 2)},
                          {FilePosition::Unit::vertex, i});
    }
    std::vector<double> corners(places.count);
    std::iota(corners.begin(), corners.end(), static_cast<double>(first));
    if (primitive.contains("indices")) {
      const GlbView indices = view_of(whole(primitive, "indices"), "SCALAR", 1);
      corners.resize(indices.count);
      for (std::size_t i = 0; i < indices.count; ++i) corners[i] = static_cast<double>(first) + indices.number(i, 0);
    }
    for (std::size_t i = 0; i + 2 < corners.size(); i += mode == k_triangles ? 3 : 1) {
      const std::size_t turned = mode == k_strip ? i % 2 : 0;
      assembly.add_polygon(std::array{corners[mode == k_fan ? 0 : i], corners[i + 1 + turned], corners[i + 2 - turned]},
                           {FilePosition::Unit::triangle, i});
    }
  }

  /// The numbers of an accessor.
  [[nodiscard]] GlbView view_of(std::size_t index, const char* type, std::size_t components) {
    const json& accessor = item("accessors", index);
    if (accessor.contains("sparse")) content_.fail("a sparse accessor is not read", "write the mesh without");
    if (member(accessor, "type") != type) fail(type, "type", member(accessor, "type"));
    const json& view = item("bufferViews", whole(accessor, "bufferView"));
    if (whole(view, "buffer") != 0 || member(item("buffers", 0), "uri").is_string()) {
      content_.fail("expected all numbers in the file itself, found a reference to others", "write one .glb file");
    }
    const ScalarType scalar = scalar_type(whole(accessor, "componentType"));
    const std::size_t size = components * size_of(scalar);
    const std::size_t stride = whole(view, "byteStride", size);
    const std::size_t count = whole(accessor, "count");
    const std::size_t begin = whole(view, "byteOffset", 0);
    const std::size_t length = whole(view, "byteLength");
    const std::size_t offset = whole(accessor, "byteOffset", 0);
    const bool is_in_view = count == 0 || offset + (count - 1) * stride + size <= length;
    if (!is_in_view || begin + length > chunks_.numbers.size()) {
      content_.fail(fmt::format("accessor {} reaches beyond the data of the file", index), k_copy_again);
    }
    size_.add(count);
    // Of none, the offset may be anywhere.
    return {chunks_.numbers.data() + (count == 0 ? 0 : begin + offset), count, stride, scalar};
  }

  [[nodiscard]] ScalarType scalar_type(std::size_t component_type) const {
    switch (component_type) {
      case 5120:
        return ScalarType::int8;
      case 5121:
        return ScalarType::uint8;
      case 5122:
        return ScalarType::int16;
      case 5123:
        return ScalarType::uint16;
      case 5125:
        return ScalarType::uint32;
      case 5126:
        return ScalarType::float32;
      default:
        fail("5120 to 5126", "componentType", component_type);
    }
  }

  const FileContent& content_;
  GlbChunks chunks_;
  json document_;
  UnfoldedSize size_;  ///< of all that accessors were used for
};

}  // namespace

TriangleMesh read_glb(const FileContent& content) {
  return GlbReader(content).read();
}

}  // namespace cloud2csg
