#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "shape/sample/ray_caster.hpp"

namespace cloud2csg {

/// Brings hits on a mesh to where the rays meet the surface that the mesh stands for; absent hits stay absent, and
/// those with no surface near them become so.
using SettleHits = std::function<void(std::span<const Ray> rays, std::span<std::optional<RayHit>> hits)>;

/// For a mesh that is no further than `reach` from the solid, and whose middle and diagonal say how precise to be. The
/// solid must outlive the function.
[[nodiscard]] SettleHits settle_on_solid(const Model& model, double reach);

}  // namespace cloud2csg
