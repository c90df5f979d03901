#include "io/step/kernel.hpp"

#include <BRepBuilderAPI_Transform.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Trsf.hxx>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>

#include "io/step/opencascade/booleans.hpp"
#include "io/step/opencascade/evaluate.hpp"
#include "io/step/opencascade/face_points.hpp"
#include "io/step/opencascade/make_body.hpp"
#include "io/step/opencascade/tessellate.hpp"
#include "io/step/opencascade/write_files.hpp"

namespace cloud2csg::brep {
namespace {

/// The kernel prints what it thinks of; the library never does.
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

/// The root's bodies within the extent; all that is not in them when the tree is a complement.
Bodies within_extent(const Bodies& bodies, const KernelJob& job, const RunContext& run) {
  const Bodies space{make_block(job.extent)};
  if (job.plan.is_complement) return subtract(space, {bodies}, {}, run);
  // What reaches beyond is an end of a half-space, which has none.
  return reaches_beyond(bodies, job.extent) ? intersect({bodies, space}, {}, run) : bodies;
}

/// The faces of `shape`, which are those of `solid` in the model's frame, with the names of their primitives.
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

/// How files are made: in which form of spheres, what volumes may differ by before and after, as a part of them, and
/// whether nodes are tested each.
struct Trial {
  SphereForm spheres;
  double same_volume;
  bool is_node_tested;
};

bool holds(const StepReading& reading, double volume, const Trial& trial) {
  return reading.is_valid && std::abs(reading.volume - volume) <= trial.same_volume * volume;
}

/// Whether a file of these bodies alone holds them.
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
  // Before it is written, which changes curves on faces where they do not agree with those in space.
  const double volume = volume_of(shape);
  write_step_file(file.path, {.part = {.shape = shape, .name = job.part_name}, .faces = {}, .program = job.program});
  return holds(read_step_file(file.path), volume, trial);
}

/// Writes the file as it is to be, and reads it again. Returns whether it holds the solid, and the components if any.
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

/// Returns whether all is well, or could not be better with spheres in another form, faces that are not joined, or
/// nodes that are tested each.
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
  // To find the node whose exact solid no file holds; by what nobody measures, since facets are worse.
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
