#pragma once

#include <string>

#include "cloud2csg/mesh.hpp"

namespace cloud2csg {

/// The bytes of a .3mf file (3MF Core Specification 1.3): one object, in millimetres, at its own coordinates. The same
/// for the same mesh. @throws Error when there is no place for a temporary file
[[nodiscard]] std::string to_3mf(const TriangleMesh& mesh);

}  // namespace cloud2csg
