#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/clouds/scalar_type.hpp"
#include "io/meshes/formats.hpp"
#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

using nlohmann::json;

constexpr std::array<std::optional<ScalarType>, 7> k_component_types{
    ScalarType::int8, ScalarType::uint8,  ScalarType::int16,  ScalarType::uint16,
    std::nullopt,     ScalarType::uint32, ScalarType::float32};  // from 5120 on

/// The first chunk describes the content in JSON, the second holds the numbers.
struct GlbChunks {
  std::string_view text;
  std::string_view numbers;
};

GlbChunks split_glb(const FileContent& content) {
  constexpr std::size_t k_head = 12;  // "glTF", version, length of the file
  constexpr std::size_t k_chunk_head = 8;
  const std::string_view bytes = content.bytes();
  const auto word = [&](std::size_t at) { return load<std::uint32_t>(bytes.data() + at, std::endian::little); };
  if (bytes.size() < k_head || !bytes.starts_with("glTF") || word(4) != 2) {
    content.fail("expected binary glTF 2.0", "is it a .glb file?");
  }
  std::array<std::string_view, 2> chunks;
  std::size_t begin = k_head;
  for (std::string_view& chunk : chunks) {
    if (bytes.size() - begin < k_chunk_head) break;
    const std::size_t length = word(begin);
    begin += k_chunk_head;
    if (length > bytes.size() - begin) {
      content.fail({FilePosition::Unit::byte, begin}, "the file ends within a chunk", k_copy_again);
    }
    chunk = bytes.substr(begin, length);
    begin += length;
  }
  return {.text = chunks[0], .numbers = chunks[1]};
}

/// Numbers in the file: `count` groups, `stride` bytes from one to the next.
struct GlbView {
  const char* base;
  std::size_t count;
  std::size_t stride;
  ScalarType type;

  [[nodiscard]] double number(std::size_t group, std::size_t component) const {
    return decode(base + group * stride + component * size_of(type), type, std::endian::little);
  }
};

/// A JSON field that is missing or of the wrong type throws json::exception.
class GlbReader {
 public:
  explicit GlbReader(const FileContent& content)
      : content_(content), chunks_(split_glb(content)), document_(json::parse(chunks_.text)), assembly_(content) {}

  TriangleMesh read() {
    const json& scene = document_.at("scenes").at(whole(document_.value("scene", json(0U))));
    place_nodes(scene, "nodes", Eigen::Affine3d::Identity(), 0);
    return std::move(assembly_).finish();
  }

 private:
  /// Converts an index, size or count; its limit keeps products from overflowing.
  [[nodiscard]] std::size_t whole(const json& value) const {
    constexpr std::uint64_t k_most = std::numeric_limits<std::uint32_t>::max();
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= k_most) return value.get<std::size_t>();
    content_.fail(fmt::format("expected a whole number from 0 to {}, found {}", k_most,
                              value.is_number() ? value.dump() : value.type_name()));
  }

  void place_nodes(const json& parent, const char* field, const Eigen::Affine3d& outer, std::size_t level) {
    if (level > k_most_levels) {
      content_.fail(fmt::format("a node contains itself, or is more than {} levels deep", k_most_levels));
    }
    if (!parent.contains(field)) return;
    for (const json& index : parent.at(field)) {
      const json& node = document_.at("nodes").at(whole(index));
      const Eigen::Affine3d motion = outer * motion_of(node);
      assembly_.start_part(motion);
      if (node.contains("mesh")) {
        for (const json& primitive : document_.at("meshes").at(whole(node.at("mesh"))).at("primitives")) {
          assembly_.start_part(motion);
          add_primitive(primitive);
        }
      }
      place_nodes(node, "children", motion, level + 1);
    }
  }

  [[nodiscard]] Eigen::Affine3d motion_of(const json& node) const {
    const auto numbers = [&](const char* field, std::vector<double> none) {
      const std::size_t count = none.size();
      std::vector<double> found = node.value(field, std::move(none));
      if (found.size() != count) content_.fail(fmt::format("expected {} numbers as \"{}\"", count, field));
      return found;
    };
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    const std::vector<double> matrix = numbers("matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    motion.affine() = Eigen::Map<const Eigen::Matrix4d>(matrix.data()).topRows<3>();
    motion.translate(Eigen::Vector3d(numbers("translation", {0, 0, 0}).data()));
    motion.rotate(Eigen::Quaterniond(numbers("rotation", {0, 0, 0, 1}).data()).normalized());
    return motion.scale(Eigen::Vector3d(numbers("scale", {1, 1, 1}).data()));
  }

  void add_primitive(const json& primitive) {
    constexpr std::size_t k_triangles = 4;
    constexpr std::size_t k_strip = 5;
    constexpr std::size_t k_fan = 6;
    const std::size_t mode = whole(primitive.value("mode", json(k_triangles)));
    if (mode < k_triangles) return;  // points or lines
    const GlbView places = view_of(primitive.at("attributes").at("POSITION"), "VEC3", 3);
    if (places.type != ScalarType::float32) content_.fail("expected positions in single precision, found others");
    for (std::size_t i = 0; i < places.count; ++i) {
      assembly_.add_vertex(std::array{places.number(i, 0), places.number(i, 1), places.number(i, 2)},
                           {FilePosition::Unit::vertex, i});
    }
    std::optional<GlbView> indices;
    if (primitive.contains("indices")) indices = view_of(primitive.at("indices"), "SCALAR", 1);
    const auto corner = [&](std::size_t i) { return indices ? indices->number(i, 0) : static_cast<double>(i); };
    const std::size_t count = indices ? indices->count : places.count;
    const std::size_t step = mode == k_triangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < count; i += step) {
      const std::size_t turned = mode == k_strip ? i % 2 : 0;
      assembly_.add_polygon(std::array{corner(mode == k_fan ? 0 : i), corner(i + 1 + turned), corner(i + 2 - turned)},
                            {FilePosition::Unit::triangle, i / step});
    }
  }

  [[nodiscard]] GlbView view_of(const json& index, std::string_view type, std::size_t components) const {
    const json& accessor = document_.at("accessors").at(whole(index));
    if (accessor.contains("sparse")) content_.fail("sparse accessors are not supported", "write the mesh without them");
    if (accessor.at("type") != type)
      content_.fail(fmt::format("expected an accessor {} of type {}", index.dump(), type));
    const json& view = document_.at("bufferViews").at(whole(accessor.at("bufferView")));
    if (whole(view.at("buffer")) != 0 || document_.at("buffers").at(0).contains("uri")) {
      content_.fail("expected all data in the file itself, found a reference to other data", "write one .glb file");
    }
    const std::size_t component_type = whole(accessor.at("componentType")) - 5120;  // wraps around
    const std::optional<ScalarType> scalar =
        component_type < k_component_types.size() ? k_component_types.at(component_type) : std::nullopt;
    if (!scalar) content_.fail(fmt::format("expected an accessor {} with a known type of numbers", index.dump()));
    const std::size_t size = components * size_of(*scalar);
    const std::size_t stride = whole(view.value("byteStride", json(size)));
    const std::size_t count = whole(accessor.at("count"));
    const std::size_t begin = whole(view.value("byteOffset", json(0U)));
    const std::size_t length = whole(view.at("byteLength"));
    const std::size_t offset = whole(accessor.value("byteOffset", json(0U)));
    if (count == 0) return {.base = nullptr, .count = 0, .stride = 0, .type = *scalar};
    if (offset + (count - 1) * stride + size > length || begin + length > chunks_.numbers.size()) {
      content_.fail(fmt::format("accessor {} reaches beyond the data of the file", index.dump()), k_copy_again);
    }
    return {.base = chunks_.numbers.data() + begin + offset, .count = count, .stride = stride, .type = *scalar};
  }

  const FileContent& content_;
  GlbChunks chunks_;
  json document_;
  MeshAssembly assembly_;
};

}  // namespace

TriangleMesh read_glb(const FileContent& content) {
  try {
    return GlbReader(content).read();
  } catch (const json::exception& error) {
    // Without the head "[json.exception.type_error.302] ".
    const std::string_view reason = error.what();
    content.fail(fmt::format("expected glTF, found an error in it: {}", reason.substr(reason.find(']') + 2)));
  }
}

}  // namespace cloud2csg
