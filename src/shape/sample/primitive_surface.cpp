#include "shape/sample/primitive_surface.hpp"

#include <utility>

#include "shape/sample/field_surface.hpp"

namespace cloud2csg {

PrimitiveSurface make_surface(const Primitive& primitive, const AlignedBox& region, const RunContext& run) {
  if (!is_plain(primitive)) return make_field_surface(primitive, region, run);
  PlainSurface plain = make_plain_surface(primitive, region);
  return {.area = plain.area, .draw = std::move(plain.draw)};
}

}  // namespace cloud2csg
