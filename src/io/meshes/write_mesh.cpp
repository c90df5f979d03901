#include <fmt/format.h>

#include <bit>
#include <iterator>
#include <string>

#include "cloud2csg/mesh.hpp"
#include "core/base/files.hpp"
#include "io/formats/formats.hpp"
#include "io/meshes/formats.hpp"

namespace cloud2csg {
namespace {

/// Little endian, as in binary STL.
template <typename Unsigned>
void append_bytes(std::string& out, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i) out.push_back(static_cast<char>(value >> (8 * i)));
}

void append_vector(std::string& out, const Eigen::Vector3d& v) {
  for (const double coordinate : v) append_bytes(out, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
}

std::string to_stl(const TriangleMesh& mesh) {
  constexpr std::size_t k_header_size = 80;
  constexpr std::size_t k_triangle_size = 50;
  std::string out = "cloud2csg";  // must not begin with "solid", which marks text
  out.reserve(k_header_size + 4 + k_triangle_size * mesh.triangles.size());
  out.resize(k_header_size, ' ');
  append_bytes(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[triangle[0]];
    const Eigen::Vector3d b = mesh.vertices[triangle[1]];
    const Eigen::Vector3d c = mesh.vertices[triangle[2]];
    append_vector(out, (b - a).cross(c - a).stableNormalized());
    for (const Eigen::Vector3d& corner : {a, b, c}) append_vector(out, corner);
    append_bytes(out, std::uint16_t{0});  // attributes: none
  }
  return out;
}

std::string to_off(const TriangleMesh& mesh) {
  std::string out = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  const auto end = std::back_inserter(out);
  const Points& v = mesh.vertices;
  for (std::size_t i = 0; i < v.size(); ++i) fmt::format_to(end, "{} {} {}\n", v.x[i], v.y[i], v.z[i]);
  for (const auto& [a, b, c] : mesh.triangles) fmt::format_to(end, "3 {} {} {}\n", a, b, c);
  return out;
}

std::string to_obj(const TriangleMesh& mesh) {
  std::string out;
  const auto end = std::back_inserter(out);
  const Points& v = mesh.vertices;
  for (std::size_t i = 0; i < v.size(); ++i) fmt::format_to(end, "v {} {} {}\n", v.x[i], v.y[i], v.z[i]);
  // Indices count from 1.
  for (const auto& [a, b, c] : mesh.triangles) fmt::format_to(end, "f {} {} {}\n", a + 1, b + 1, c + 1);
  return out;
}

}  // namespace

void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
  switch (format_to_write(file, {FileKind::mesh})) {
    case FileFormat::Id::stl:
      return write_text_file(file, to_stl(mesh));
    case FileFormat::Id::off:
      return write_text_file(file, to_off(mesh));
    case FileFormat::Id::obj:
      return write_text_file(file, to_obj(mesh));
    default:
      return write_text_file(file, to_3mf(mesh));
  }
}

}  // namespace cloud2csg
