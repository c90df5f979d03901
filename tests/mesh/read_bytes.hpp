#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "cloud2csg/mesh.hpp"
#include "mesh/shapes.hpp"

namespace cloud2csg::shapes {

/// The mesh of a file with this name and these bytes.
inline TriangleMesh read_bytes(const std::string& name, const std::string& bytes) {
  const std::filesystem::path file = temporary(name.c_str());
  std::ofstream(file, std::ios::binary) << bytes;
  struct Remove {
    const std::filesystem::path& file;
    ~Remove() { std::filesystem::remove(file); }
  } const remove{file};
  return read_mesh(file);
}

inline double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  return area;
}

/// Of all triangles together, with its direction: as long as area_of() where none turns over.
inline Eigen::Vector3d area_vector(const TriangleMesh& mesh) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  }
  return area;
}

}  // namespace cloud2csg::shapes
