#pragma once

#include "raw/solids/choose_faces.hpp"

namespace cloud2csg {

/// The border of a set of faces as closed paths. Edges of one curve in a row become one segment, and a whole circle
/// becomes two halves. Paths touch where the faces do only in a vertex. O(edges)
[[nodiscard]] Profile outline_of(const Drawing& drawing, const FaceSet& faces);

/// Whether that border is a valid profile: not empty, and nowhere crossing or touching itself or, if turned, the axis.
/// O(segments^2)
[[nodiscard]] bool is_writable(const Drawing& drawing, const FaceSet& faces);

}  // namespace cloud2csg
