#include "io/step/kernel.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <gp_Trsf.hxx>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cloud2csg/geometry.hpp"
#include "cloud2csg/mesh.hpp"
#include "io/step/opencascade/bodies.hpp"
#include "io/step/opencascade/booleans.hpp"
#include "io/step/opencascade/evaluate.hpp"
#include "io/step/opencascade/make_body.hpp"
#include "io/step/opencascade/write_files.hpp"

namespace cloud2csg::brep {
namespace {

/// A few interior points of a face; none if the face is too thin.
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
  // Refines a parameter grid until enough of its points are in the face.
  for (int steps = 3; steps <= k_finest && points.size() < k_enough; steps = 2 * steps + 1) {
    points.clear();
    for (int i = 0; i < steps && points.size() < k_enough; ++i) {
      for (int j = 0; j < steps && points.size() < k_enough; ++j) {
        // Avoids the middle of intervals, where symmetric parts have corners.
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

// Gives even the smallest circle 18 facets.
constexpr double k_widest_turn = 0.35;

/// Corners by position. The kernel gives both faces of an edge the same coordinates up to rounding.
class Corners {
 public:
  explicit Corners(TriangleMesh& mesh) : mesh_(mesh) {}

  std::uint32_t at(const gp_Pnt& point) {
    // Near the border of a cell, an equal corner may be in the next one.
    constexpr double k_aside = 0.25;
    for (const double x : {-k_aside, k_aside}) {
      for (const double y : {-k_aside, k_aside}) {
        for (const double z : {-k_aside, k_aside}) {
          const auto known = index_of_.find(cell_of(point, {x, y, z}));
          if (known != index_of_.end()) return known->second;
        }
      }
    }
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    index_of_.emplace(cell_of(point, {0, 0, 0}), next);
    mesh_.vertices.push_back({point.X(), point.Y(), point.Z()});
    return next;
  }

 private:
  static std::array<std::int64_t, 3> cell_of(const gp_Pnt& point, const gp_XYZ& shift) {
    constexpr double k_width = 1e-10;  // below the kernel's precision of 1e-7, above rounding near the origin
    std::array<std::int64_t, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      cell[static_cast<std::size_t>(k)] = std::llround(point.Coord(k + 1) / k_width + shift.Coord(k + 1));
    }
    return cell;
  }

  TriangleMesh& mesh_;
  std::map<std::array<std::int64_t, 3>, std::uint32_t> index_of_ = {};
};

void add_face(const TopoDS_Face& face, Corners& corners, TriangleMesh& mesh) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
  if (triangulation.IsNull()) throw std::runtime_error("the kernel finds no triangles for a face");
  std::vector<std::uint32_t> corner_of;
  for (int i = 1; i <= triangulation->NbNodes(); ++i) {
    corner_of.push_back(corners.at(triangulation->Node(i).Transformed(location.Transformation())));
  }
  for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
    std::array<int, 3> nodes{};
    triangulation->Triangle(i).Get(nodes[0], nodes[1], nodes[2]);
    if (face.Orientation() == TopAbs_REVERSED) std::swap(nodes[1], nodes[2]);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = corner_of[static_cast<std::size_t>(nodes[k] - 1)];
    // Degenerate at the poles of a sphere and the tip of a cone.
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    mesh.triangles.push_back(triangle);
  }
}

/// Triangulates the bodies' surfaces within `deviation`. Both faces of an edge share its corners, so each body is
/// closed. Different bodies share no corners. @throws Standard_Failure, std::runtime_error for a face without triangles
TriangleMesh tessellate(const Bodies& bodies, double deviation) {
  TriangleMesh mesh;
  for (const Body& body : bodies) {
    const BRepMesh_IncrementalMesh triangulate(body.shape, deviation, false, k_widest_turn, false);
    Corners corners(mesh);
    for (TopExp_Explorer faces(body.shape, TopAbs_FACE); faces.More(); faces.Next()) {
      add_face(TopoDS::Face(faces.Current()), corners, mesh);
    }
  }
  return mesh;
}

/// The kernel prints messages; the library must not.
void silence() {
  static std::once_flag once;
  std::call_once(once, [] { Message::DefaultMessenger()->ChangePrinters().Clear(); });
}

TopoDS_Shape to_model(const TopoDS_Shape& shape, const WorkFrame& frame) {
  if (frame.is_identity()) return shape;
  gp_Trsf scaling;
  scaling.SetScale(gp_Pnt(0, 0, 0), frame.scale);
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(frame.offset.x(), frame.offset.y(), frame.offset.z()));
  return BRepBuilderAPI_Transform(shape, shift * scaling, true).Shape();
}

bool reaches_beyond(const Bodies& bodies, const AlignedBox& extent) {
  Bnd_Box all;
  for (const Body& body : bodies) all.Add(body.box);
  if (all.IsVoid()) return false;
  const gp_Pnt least = all.CornerMin();
  const gp_Pnt most = all.CornerMax();
  return !extent.contains(
      AlignedBox(Eigen::Vector3d(least.X(), least.Y(), least.Z()), Eigen::Vector3d(most.X(), most.Y(), most.Z())));
}

/// The root's bodies within the extent, or the rest of the extent for a complement.
Bodies within_extent(const Bodies& bodies, const KernelJob& job, const RunContext& run) {
  const Bodies space{make_block(job.extent)};
  if (job.plan.is_complement) return subtract(space, {bodies}, {}, run);
  // Only half-spaces, which are unbounded, reach beyond the extent.
  return reaches_beyond(bodies, job.extent) ? intersect({bodies, space}, {}, run) : bodies;
}

/// The faces of `shape` with the names of their primitives. `shape` is `solid` in the model's frame.
std::vector<NamedShape> named_faces(const TopoDS_Shape& solid, const TopoDS_Shape& shape, const KernelJob& job,
                                    const KernelHost& host) {
  std::vector<NamedShape> faces;
  TopExp_Explorer in_model(shape, TopAbs_FACE);
  for (TopExp_Explorer in_frame(solid, TopAbs_FACE); in_frame.More(); in_frame.Next(), in_model.Next()) {
    const std::vector<Eigen::Vector3d> points = points_on_face(TopoDS::Face(in_frame.Current()));
    if (points.empty()) continue;
    faces.push_back({.shape = in_model.Current(), .name = job.names[host.primitive_at(points)]});
  }
  return faces;
}

Bodies joined_faces(const Bodies& bodies) {
  Bodies joined;
  for (const Body& body : bodies) joined.push_back({.shape = with_joined_faces(body.shape), .box = body.box});
  return joined;
}

std::size_t count_faces(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) ++count;
  return count;
}

StepContent step_content(const TopoDS_Shape& solid, const KernelJob& job, const KernelHost& host) {
  const TopoDS_Shape shape = to_model(solid, job.frame);
  return {.part = {.shape = shape, .name = job.part_name},
          .faces = named_faces(solid, shape, job, host),
          .assembly_name = job.assembly_name,
          .program = job.program};
}

std::vector<NamedShape> components_of(const KernelJob& job, const KernelHost& host) {
  std::vector<NamedShape> components;
  for (const PrimitiveIndex index : job.components) {
    const TopoDS_Shape component = shape_of(make_bodies(host.solid_of(index), SphereForm::whole));
    components.push_back({.shape = to_model(component, job.frame), .name = job.names[index]});
  }
  return components;
}

/// Settings for a file: form of spheres, relative volume change allowed in the file, whether to test each node.
struct Trial {
  SphereForm spheres;
  double same_volume;
  bool is_node_tested;
};

bool holds(const StepReading& reading, double volume, const Trial& trial) {
  return reading.is_valid && std::abs(reading.volume - volume) <= trial.same_volume * volume;
}

/// Whether a file of only these bodies preserves them.
bool survives_file(const Bodies& bodies, const KernelJob& job, std::size_t node, const Trial& trial) {
  struct Removed {
    std::filesystem::path path;
    ~Removed() {
      std::error_code ignored;
      std::filesystem::remove(path, ignored);
    }
  };
  const Removed file{job.file.string() + "-" + std::to_string(node)};
  const TopoDS_Shape shape = to_model(shape_of(bodies), job.frame);
  // Measured before writing, which changes face curves that disagree with their space curves.
  const double volume = volume_of(shape);
  write_step_file(file.path, {.part = {.shape = shape, .name = job.part_name}, .faces = {}, .program = job.program});
  return holds(read_step_file(file.path), volume, trial);
}

/// Writes the file and reads it again. Returns whether it preserves the solid and any components.
bool write_step(const Bodies& bodies, const KernelJob& job, const KernelHost& host, const Trial& trial,
                KernelResult& result) {
  const double volume = std::pow(job.frame.scale, 3) * volume_of(bodies);
  const TopoDS_Shape shape = shape_of(bodies);
  StepContent content = step_content(shape, job, host);
  content.components = components_of(job, host);
  double beside = 0;
  for (const NamedShape& component : content.components) beside += volume_of(component.shape);
  write_step_file(job.file, content);
  host.name_step(job.file);
  const StepReading reading = read_step_file(job.file);
  result.is_valid = holds(reading, volume + beside, trial);
  result.volume = reading.volume - beside;
  result.faces = count_faces(shape);
  result.solids = reading.solids - std::min(reading.solids, content.components.size());
  return result.is_valid;
}

void write_brep(const Bodies& bodies, const KernelJob& job, KernelResult& result) {
  const TopoDS_Shape shape = to_model(shape_of(joined_faces(bodies)), job.frame);
  result.is_valid = is_valid(shape);
  result.volume = volume_of(shape);
  result.solids = bodies.size();
  result.faces = count_faces(shape);
  write_brep_file(job.file, shape);
}

void make_mesh(const Bodies& bodies, const KernelJob& job, KernelResult& result) {
  const TopoDS_Shape shape = shape_of(bodies);
  result.is_valid = is_valid(shape);
  result.volume = std::pow(job.frame.scale, 3) * volume_of(shape);
  result.solids = bodies.size();
  result.faces = count_faces(shape);
  result.mesh = tessellate(bodies, job.mesh_deviation);
}

/// Returns false only if another form of spheres, unjoined faces or testing each node might help.
bool run_job(const KernelJob& job, const KernelHost& host, const Trial& trial, KernelResult& result) {
  FileTest test;
  if (trial.is_node_tested) {
    test = [&](std::size_t node, const Bodies& bodies) { return survives_file(bodies, job, node, trial); };
  }
  Evaluation evaluation = evaluate(job, host, trial.spheres, test);
  result.failures = std::move(evaluation.failures);
  result.healed_faces = evaluation.healed_faces;
  const Bodies bodies = within_extent(evaluation.bodies, job, host.run());
  result.is_empty = bodies.empty();
  if (result.is_empty) return true;
  host.run().throw_if_stopped();
  if (job.format == KernelFormat::step) {
    return write_step(joined_faces(bodies), job, host, trial, result) ||
           (trial.spheres == SphereForm::split && write_step(bodies, job, host, trial, result));
  }
  if (job.format == KernelFormat::mesh) {
    make_mesh(joined_faces(bodies), job, result);
  } else {
    write_brep(bodies, job, result);
  }
  return true;
}

void make_solid(const KernelJob& job, const KernelHost& host, KernelResult& result) {
  constexpr double k_rounding = 1e-5;
  // The last trial finds the node that no file preserves. Facets would be worse than its tolerance.
  const double unnoticed = std::max(k_rounding, 0.1 * job.volume_tolerance);
  for (const Trial& trial : {Trial{SphereForm::whole, k_rounding, false}, Trial{SphereForm::split, k_rounding, false},
                             Trial{SphereForm::split, unnoticed, true}}) {
    if (run_job(job, host, trial, result)) return;
  }
}

}  // namespace

}  // namespace cloud2csg::brep

extern "C" {

__attribute__((visibility("default"))) int cloud2csg_kernel_version() {
  return cloud2csg::brep::k_kernel_version;
}

__attribute__((visibility("default"))) void cloud2csg_kernel_run(const cloud2csg::brep::KernelJob* job,
                                                                 const cloud2csg::brep::KernelHost* host,
                                                                 cloud2csg::brep::KernelResult* result) {
  using namespace cloud2csg::brep;
  silence();
  try {
    make_solid(*job, *host, *result);
  } catch (const Standard_Failure& failure) {
    result->error = std::string("the kernel says: ") + failure.GetMessageString();
  } catch (const std::runtime_error& failure) {
    result->error = failure.what();
  }
}
}
