#pragma once

#include <string>

#include "cloud2csg/mesh.hpp"
#include "io/clouds/file_content.hpp"

/// One reader a format; read_mesh() chooses by the file's ending. Whatever the bytes are, a reader gives a mesh whose
/// indices are of vertices that there are and whose coordinates are finite, or throws Error naming line, byte or
/// triangle. Vertices are as in the file, not joined; there may be no triangles. Memory is in proportion to the file.
namespace cloud2csg {

/// Binary or text.
[[nodiscard]] TriangleMesh read_stl(const FileContent& content);
/// Text, with or without normals and colours.
[[nodiscard]] TriangleMesh read_off(const FileContent& content);
[[nodiscard]] TriangleMesh read_obj(const FileContent& content);
/// The elements `vertex` and `face`.
[[nodiscard]] TriangleMesh read_ply_mesh(const FileContent& content);
/// The objects that are to be built, in millimetres (3MF Core Specification 1.3, without extensions).
[[nodiscard]] TriangleMesh read_3mf(const FileContent& content);
/// The bytes of a .3mf file: one object, in millimetres, at its own coordinates. The same for the same mesh.
[[nodiscard]] std::string to_3mf(const TriangleMesh& mesh);
/// The triangles of the scene (glTF 2.0), where the file itself holds them.
[[nodiscard]] TriangleMesh read_glb(const FileContent& content);

}  // namespace cloud2csg
