#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cloud2csg/mesh.hpp"
#include "cloud2csg/run_context.hpp"
#include "core/fields/tree_volume.hpp"
#include "core/primitive/profile.hpp"
#include "io/step/solid_plan.hpp"

/// Interface of library and OpenCASCADE module. The module knows solids; it asks its host about trees and meshes.
namespace cloud2csg::brep {

/// A closed polyhedral surface of one or more pieces: corner indices, counter-clockwise seen from outside.
struct Facets {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::vector<std::uint32_t>> faces;
};

/// An Extrusion or, without a height, a Revolution.
struct SweptProfile {
  std::vector<ProfileRegion> regions;
  std::optional<double> height;
  double angle_deg = 360;  ///< of a Revolution
};

struct KernelSolid {
  std::variant<Box, Sphere, Cylinder, Cone, Torus, SweptProfile, Facets> shape;
  Pose pose = {};
};

/// Maps the kernel's frame to the model's: x_model = scale * x + offset. The kernel's absolute tolerances suit parts of
/// some hundred millimetres near the origin.
struct WorkFrame {
  double scale = 1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_identity() const { return scale == 1 && offset.isZero(0); }
};

enum class KernelFormat { step, brep, mesh };

struct KernelJob {
  SolidPlan plan = {};
  std::vector<std::vector<std::size_t>> levels = {};  ///< as from levels_of()
  AlignedBox extent = {};                             ///< in the kernel's frame: all of space as far as the model goes
  double size = 1;                                    ///< diagonal of `extent`
  double volume_tolerance = 1e-3;
  WorkFrame frame = {};
  KernelFormat format = KernelFormat::step;
  std::filesystem::path file = {};  ///< overwritten, except for a mesh
  double mesh_deviation = 0;        ///< mesh to surface, in the kernel's frame
  /// Names are plain letters and digits, which the host replaces by the real ones (step_text.hpp).
  std::string part_name = {};
  std::string assembly_name = {};  ///< part and components together
  std::string program = {};        ///< name and version, for the head of the file
  std::vector<std::string> names = {};
  std::vector<PrimitiveIndex> components = {};  ///< primitives to write beside the solid
};

struct KernelFailure {
  std::size_t node;  ///< plan node
  std::string reason;
};

struct KernelResult {
  bool is_empty = false;  ///< nothing was made then
  bool is_valid = false;
  double volume = 0;  ///< in the model's units
  std::size_t solids = 0;
  std::size_t faces = 0;
  std::size_t healed_faces = 0;
  TriangleMesh mesh = {};  ///< in the kernel's frame, if requested
  std::vector<KernelFailure> failures = {};
  std::string error = {};  ///< why the file could not be made; empty on success
};

/// Answers are in the kernel's frame. Called concurrently from several threads.
class KernelHost {
 public:
  KernelHost() = default;
  virtual ~KernelHost() = default;
  KernelHost(const KernelHost&) = delete;
  KernelHost& operator=(const KernelHost&) = delete;
  KernelHost(KernelHost&&) = delete;
  KernelHost& operator=(KernelHost&&) = delete;

  [[nodiscard]] virtual KernelSolid solid_of(PrimitiveIndex primitive) const = 0;
  /// The volume of a plan node; absent for an unbounded node. @throws Cancelled
  [[nodiscard]] virtual std::optional<VolumeEstimate> volume_of(std::size_t node) const = 0;
  /// The facets of a plan node's surface. @throws Cancelled
  [[nodiscard]] virtual Facets facets_of(std::size_t node) const = 0;
  /// The primitive whose surface fits these points best.
  [[nodiscard]] virtual PrimitiveIndex primitive_at(const std::vector<Eigen::Vector3d>& points) const = 0;
  /// Replaces the tokens in a STEP file by the real names.
  virtual void name_step(const std::filesystem::path& file) const = 0;
  [[nodiscard]] virtual const RunContext& run() const = 0;
};

/// Symbols of the module's two functions. Only equal versions of module and library are compatible.
inline constexpr const char* k_kernel_version_symbol = "cloud2csg_kernel_version";
inline constexpr const char* k_kernel_run_symbol = "cloud2csg_kernel_run";
inline constexpr int k_kernel_version = 4;
using KernelVersion = int (*)();
/// @throws Cancelled, and what the host throws
using KernelRun = void (*)(const KernelJob* job, const KernelHost* host, KernelResult* result);

}  // namespace cloud2csg::brep
