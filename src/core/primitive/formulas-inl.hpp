// Included once per instruction set (Highway's foreach_target), hence no ordinary include guard.
#if defined(CLOUD2CSG_PRIMITIVE_FORMULAS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef CLOUD2CSG_PRIMITIVE_FORMULAS_INL
#undef CLOUD2CSG_PRIMITIVE_FORMULAS_INL
#else
#define CLOUD2CSG_PRIMITIVE_FORMULAS_INL
#endif

#include <variant>

#include "core/primitive/displacement-inl.hpp"
#include "core/primitive/profile-inl.hpp"
#include "core/primitive/revolved-inl.hpp"
#include "core/primitive/shape.hpp"
#include "core/primitive/solids-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace cloud2csg::HWY_NAMESPACE {

template <class Tag, class Solid, class Loop>
void run_placed(Tag tag, const Solid& solid, const Placement& placement, const Loop& loop) {
  if (placement.is_unrotated) {
    loop.run(tag, Placed(ShiftedFrame<Tag>(tag, placement), solid));
  } else {
    loop.run(tag, Placed(RotatedFrame<Tag>(tag, placement), solid));
  }
}

/// Calls loop.run(tag, formula) with the formula of the undisplaced shape. Precondition: it is not an Expression.
template <class Tag, class Loop>
void run_formula(Tag tag, const Primitive& primitive, const Placement& placement, const Loop& loop) {
  const Shape& shape = primitive.shape;
  if (const auto* box = std::get_if<Box>(&shape)) {
    run_placed(tag, BoxFormula<Tag>(tag, *box), placement, loop);
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    loop.run(tag, SphereFormula<Tag>(tag, *sphere, placement));
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    using Profile = CylinderProfile<Tag>;
    run_placed(tag, Revolved<Tag, Profile>(tag, Profile(tag, *cylinder)), placement, loop);
  } else if (const auto* cone = std::get_if<Cone>(&shape)) {
    using Profile = ConeProfile<Tag>;
    run_placed(tag, Revolved<Tag, Profile>(tag, Profile(tag, *cone)), placement, loop);
  } else if (const auto* torus = std::get_if<Torus>(&shape)) {
    using Profile = TorusProfile<Tag>;
    run_placed(tag, Revolved<Tag, Profile>(tag, Profile(tag, *torus)), placement, loop);
  } else if (std::holds_alternative<HalfSpace>(shape)) {
    loop.run(tag, HalfSpaceFormula<Tag>(tag, placement));
  } else if (const auto* polytope = std::get_if<Polytope>(&shape)) {
    const std::vector<WorldPlane> planes = world_planes(*polytope, primitive.pose);
    loop.run(tag, PolytopeFormula<Tag>(tag, planes));
  } else if (const auto* extrusion = std::get_if<Extrusion>(&shape)) {
    const std::vector<ProfileEdge> edges = profile_edges(extrusion->profile, false);
    run_placed(tag, ExtrusionFormula<Tag>(tag, edges, extrusion->height), placement, loop);
  } else if (const auto* revolution = std::get_if<Revolution>(&shape)) {
    const std::vector<ProfileEdge> edges = profile_edges(revolution->profile, true);
    using Profile = PathsProfile<Tag>;
    if (is_full_turn(*revolution)) {
      run_placed(tag, Revolved<Tag, Profile>(tag, Profile(tag, edges)), placement, loop);
    } else {
      const std::vector<ProfileEdge> caps = profile_edges(revolution->profile, false);
      run_placed(tag, SectorFormula<Tag>(tag, edges, caps, turn_of(*revolution)), placement, loop);
    }
  }
}

}  // namespace cloud2csg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
