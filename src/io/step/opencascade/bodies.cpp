#include "io/step/opencascade/bodies.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Precision.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Sphere.hxx>

namespace cloud2csg::brep {

Body body_of(const TopoDS_Shape& solid) {
  Body body{.shape = solid, .box = {}};
  BRepBndLib::Add(solid, body.box, false);
  return body;
}

Bodies bodies_of(const TopoDS_Shape& shape) {
  Bodies bodies;
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) {
    bodies.push_back(body_of(solids.Current()));
  }
  return bodies;
}

TopoDS_Shape shape_of(const Bodies& bodies) {
  if (bodies.size() == 1) return bodies.front().shape;
  const BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const Body& body : bodies) builder.Add(compound, body.shape);
  return compound;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

double volume_of(const Bodies& bodies) {
  double volume = 0;
  for (const Body& body : bodies) volume += volume_of(body.shape);
  return volume;
}

bool is_valid(const TopoDS_Shape& shape) {
  return BRepCheck_Analyzer(shape).IsValid();
}

bool is_closed(const Body& body, double tolerance) {
  // The kernel measures volume from the middle of all corners, which a block beside the body moves.
  const gp_Pnt corner = body.box.CornerMax();
  const double size = corner.Distance(body.box.CornerMin());
  const gp_Pnt from = corner.Translated(gp_Vec(size, size, size));
  const Body block = body_of(BRepPrimAPI_MakeBox(from, size, size, size).Solid());
  const double volume = volume_of(body.shape);
  const double from_elsewhere = volume_of(shape_of({body, block})) - size * size * size;
  return std::abs(from_elsewhere - volume) <= tolerance * std::abs(volume);
}

Healed healed(const TopoDS_Shape& shape) {
  const BRepCheck_Analyzer before(shape);
  if (before.IsValid()) return {.shape = shape, .faces = 0};
  std::size_t invalid_faces = 0;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    if (!before.IsValid(faces.Current())) ++invalid_faces;
  }
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(shape);
  fix->Perform();
  return {.shape = fix->Shape(), .faces = invalid_faces};
}

namespace {

/// The edges between curved faces. Their faces stay apart, because ShapeUpgrade_UnifySameDomain up to 7.9 may never end
/// on them (OCCT issues 544 and 0032949), and spheres may have different poles.
TopTools_MapOfShape edges_between_curved_faces(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of_edges;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edges);
  TopTools_MapOfShape edges;
  for (int i = 1; i <= faces_of_edges.Extent(); ++i) {
    const TopTools_ListOfShape& faces = faces_of_edges(i);
    if (faces.Extent() != 2) continue;
    const BRepAdaptor_Surface first(TopoDS::Face(faces.First()), false);
    const BRepAdaptor_Surface second(TopoDS::Face(faces.Last()), false);
    if (first.GetType() != GeomAbs_Plane && second.GetType() != GeomAbs_Plane) edges.Add(faces_of_edges.FindKey(i));
  }
  return edges;
}

TopoDS_Shape joined(const TopoDS_Shape& shape) {
  ShapeUpgrade_UnifySameDomain unify(shape, true, true, false);
  unify.KeepShapes(edges_between_curved_faces(shape));
  unify.Build();
  return unify.Shape();
}

}  // namespace

TopoDS_Shape with_joined_faces(const TopoDS_Shape& shape) {
  constexpr double k_same_volume = 1e-6;
  try {
    const TopoDS_Shape result = joined(shape);
    if (result.IsNull() || !is_valid(result)) return shape;
    const double volume = volume_of(shape);
    return std::abs(volume_of(result) - volume) <= k_same_volume * std::abs(volume) ? result : shape;
  } catch (const Standard_Failure&) {
    return shape;
  }
}

}  // namespace cloud2csg::brep
