#include "io/step/opencascade/face_points.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <Precision.hxx>

namespace cloud2csg::brep {

std::vector<Eigen::Vector3d> points_on_face(const TopoDS_Face& face) {
  constexpr std::size_t k_enough = 3;
  constexpr int k_finest = 64;
  double u_low = 0;
  double u_high = 0;
  double v_low = 0;
  double v_high = 0;
  BRepTools::UVBounds(face, u_low, u_high, v_low, v_high);
  BRepTopAdaptor_FClass2d classifier(face, Precision::PConfusion());
  const BRepAdaptor_Surface surface(face);
  std::vector<Eigen::Vector3d> points;
  // Lattices of the parameters, finer until enough of their middles are in the face.
  for (int steps = 3; steps <= k_finest && points.size() < k_enough; steps = 2 * steps + 1) {
    points.clear();
    for (int i = 0; i < steps && points.size() < k_enough; ++i) {
      for (int j = 0; j < steps && points.size() < k_enough; ++j) {
        // Off the middle of the intervals, where symmetric parts have their corners.
        const double u = u_low + (u_high - u_low) * (i + 0.47) / steps;
        const double v = v_low + (v_high - v_low) * (j + 0.53) / steps;
        if (classifier.Perform(gp_Pnt2d(u, v)) != TopAbs_IN) continue;
        const gp_Pnt point = surface.Value(u, v);
        points.emplace_back(point.X(), point.Y(), point.Z());
      }
    }
  }
  return points;
}

}  // namespace cloud2csg::brep
