#pragma once

#include "raw/solids/choose_faces.hpp"

namespace cloud2csg {

/// The border of a set of faces as closed paths. Edges of one curve in a row become one segment, and a whole circle
/// becomes two halves. Paths touch where the faces do only in a vertex. O(edges)
[[nodiscard]] Profile outline_of(const Drawing& drawing, const FaceSet& faces);

/// Whether the profile is not empty, and nowhere crosses or touches itself or, if turned, the axis. O(segments^2)
[[nodiscard]] bool is_valid(const Profile& profile, bool is_turned);

/// Whether the border of the faces is a valid profile. O(segments^2)
[[nodiscard]] bool is_writable(const Drawing& drawing, const FaceSet& faces);

}  // namespace cloud2csg
