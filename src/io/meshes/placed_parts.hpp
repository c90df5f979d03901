#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "io/clouds/file_content.hpp"

namespace cloud2csg {

/// A piece of a mesh, and others that go with it.
struct MeshPart {
  struct Child {
    std::size_t part;  ///< among all
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  };

  TriangleMesh mesh = {};
  std::vector<Child> children = {};
};

/// How much was made of a file: few of its bytes, used many times, could make more than any memory holds.
class UnfoldedSize {
 public:
  explicit UnfoldedSize(const FileContent& content) : content_(content) {}
  /// @throws Error when it is 10 million more than the file has bytes
  void add(std::size_t elements);

 private:
  const FileContent& content_;
  std::size_t size_ = 0;
};

/// The roots, with all that goes with them, at their places; turned inside out where a motion mirrors, so that the
/// outside stays outside. O(what comes out)
/// @throws Error where a part is within itself, where the parts are nested more than 100 levels deep, or as
/// UnfoldedSize does
[[nodiscard]] TriangleMesh place_parts(const FileContent& content, std::span<const MeshPart> parts,
                                       std::span<const MeshPart::Child> roots);

}  // namespace cloud2csg
