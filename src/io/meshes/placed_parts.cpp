#include "io/meshes/placed_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <utility>

#include "io/meshes/mesh_assembly.hpp"

namespace cloud2csg {
namespace {

using Eigen::Affine3d;

constexpr std::size_t k_most_levels = 100;
constexpr std::size_t k_most_repeated = 10'000'000;

class PartPlacer {
 public:
  PartPlacer(const FileContent& content, std::span<const MeshPart> parts)
      : content_(content), parts_(parts), size_(content) {}

  void place(const MeshPart::Child& child, const Affine3d& outer, std::size_t level) {
    assert(child.part < parts_.size());
    if (level > k_most_levels) {
      content_.fail(fmt::format("a part is within itself, or more than {} levels deep", k_most_levels));
    }
    const MeshPart& part = parts_[child.part];
    const Affine3d motion = outer * child.motion;
    size_.add(1 + part.mesh.vertices.size() + part.mesh.triangles.size());
    append(part.mesh, motion);
    for (const MeshPart::Child& inner : part.children) place(inner, motion, level + 1);
  }

  TriangleMesh finish() && { return std::move(mesh_); }

 private:
  void append(const TriangleMesh& part, const Affine3d& motion) {
    const auto offset = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      const Eigen::Vector3d place = motion * part.vertices[i];
      check_coordinates(content_, place, {FilePosition::Unit::vertex, offset + i});
      mesh_.vertices.push_back(place);
    }
    const bool mirrors = motion.linear().determinant() < 0.0;
    for (const auto& [a, b, c] : part.triangles) {
      mesh_.triangles.push_back({offset + a, offset + (mirrors ? c : b), offset + (mirrors ? b : c)});
    }
  }

  const FileContent& content_;
  std::span<const MeshPart> parts_;
  TriangleMesh mesh_ = {};
  UnfoldedSize size_;
};

}  // namespace

void UnfoldedSize::add(std::size_t elements) {
  size_ += elements;
  if (size_ > k_most_repeated + content_.bytes().size()) {
    content_.fail("parts are repeated so often that the mesh is too large", "write each of them to a file");
  }
}

TriangleMesh place_parts(const FileContent& content, std::span<const MeshPart> parts,
                         std::span<const MeshPart::Child> roots) {
  PartPlacer placer(content, parts);
  for (const MeshPart::Child& root : roots) placer.place(root, Affine3d::Identity(), 1);
  return std::move(placer).finish();
}

}  // namespace cloud2csg
