#pragma once

#include <string>

#include "cloud2csg/mesh.hpp"
#include "io/clouds/file_content.hpp"

/// One reader a format; read_mesh() chooses by the file's ending. For any input, a reader returns a mesh with valid
/// indices and finite coordinates or throws Error with the line, byte or triangle. Vertices are as in the file, not
/// joined. The mesh may have no triangles. Memory is proportional to the file size.
namespace cloud2csg {

/// Binary or text.
[[nodiscard]] TriangleMesh read_stl(const FileContent& content);
/// Text, with or without normals and colours.
[[nodiscard]] TriangleMesh read_off(const FileContent& content);
[[nodiscard]] TriangleMesh read_obj(const FileContent& content);
/// The elements `vertex` and `face`.
[[nodiscard]] TriangleMesh read_ply_mesh(const FileContent& content);
/// The objects in the build section, in millimetres (3MF Core Specification 1.3, without extensions).
[[nodiscard]] TriangleMesh read_3mf(const FileContent& content);
/// A .3mf file with one untransformed object in millimetres. Equal meshes give equal bytes.
[[nodiscard]] std::string to_3mf(const TriangleMesh& mesh);
/// The triangles of the scene (glTF 2.0) that the file itself holds.
[[nodiscard]] TriangleMesh read_glb(const FileContent& content);

}  // namespace cloud2csg
