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
#include "io/step/solid_plan.hpp"

/// What the library and the module with OpenCASCADE say to each other. The module knows solids, not trees or meshes:
/// what it needs of these it asks its host.
namespace cloud2csg::brep {

/// A closed surface of flat faces, in several pieces maybe: corner numbers counter-clockwise seen from outside.
struct Facets {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::vector<std::uint32_t>> faces;
};

struct KernelSolid {
  std::variant<Box, Sphere, Cylinder, Cone, Torus, Facets> shape;
  Pose pose = {};
};

/// From the frame that the kernel works in to that of the model: x_model = scale * x + offset. The kernel's tolerances
/// are absolute and meant for parts of some hundred millimetres near the origin.
struct WorkFrame {
  double scale = 1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_identity() const { return scale == 1 && offset.isZero(0); }
};

enum class KernelFormat { step, brep, mesh };

struct KernelJob {
  SolidPlan plan = {};
  std::vector<std::vector<std::size_t>> levels = {};  ///< of the plan, as levels_of() has them
  AlignedBox extent = {};                             ///< in the kernel's frame: all of space, as far as the model goes
  double size = 1;                                    ///< diagonal of `extent`
  double volume_tolerance = 1e-3;
  WorkFrame frame = {};
  KernelFormat format = KernelFormat::step;
  std::filesystem::path file = {};  ///< to be written over, but for a mesh
  double mesh_deviation = 0;        ///< of a mesh from the surface, in the kernel's frame
  /// Names are plain letters and digits: the host puts the real ones in their place (step_text.hpp).
  std::string part_name = {};
  std::string assembly_name = {};               ///< of part and components
  std::string program = {};                     ///< name and version, for the head of the file
  std::vector<std::string> names = {};          ///< of all primitives
  std::vector<PrimitiveIndex> components = {};  ///< primitives to write beside the solid
};

struct KernelFailure {
  std::size_t node;  ///< of the plan
  std::string reason;
};

struct KernelResult {
  bool is_empty = false;  ///< nothing was made then
  bool is_valid = false;
  double volume = 0;  ///< in the model's units
  std::size_t solids = 0;
  std::size_t faces = 0;
  std::size_t healed_faces = 0;
  TriangleMesh mesh = {};  ///< in the kernel's frame, when it was asked for
  std::vector<KernelFailure> failures = {};
  std::string error = {};  ///< not empty: the file could not be made, and this is why
};

/// Answers are in the kernel's frame. Called from several threads at a time.
class KernelHost {
 public:
  KernelHost() = default;
  virtual ~KernelHost() = default;
  KernelHost(const KernelHost&) = delete;
  KernelHost& operator=(const KernelHost&) = delete;
  KernelHost(KernelHost&&) = delete;
  KernelHost& operator=(KernelHost&&) = delete;

  [[nodiscard]] virtual KernelSolid solid_of(PrimitiveIndex primitive) const = 0;
  /// Of a node of the plan; absent when it has no ends. @throws Cancelled
  [[nodiscard]] virtual std::optional<VolumeEstimate> volume_of(std::size_t node) const = 0;
  /// The node's surface with facets. @throws Cancelled
  [[nodiscard]] virtual Facets facets_of(std::size_t node) const = 0;
  /// The primitive on whose surface these points are best.
  [[nodiscard]] virtual PrimitiveIndex primitive_at(const std::vector<Eigen::Vector3d>& points) const = 0;
  /// Puts the real names into a STEP file in place of their tokens.
  virtual void name_step(const std::filesystem::path& file) const = 0;
  [[nodiscard]] virtual const RunContext& run() const = 0;
};

/// The module's two functions, by name. The version must be that of the library: there is no other promise between
/// them.
inline constexpr const char* k_kernel_version_symbol = "cloud2csg_kernel_version";
inline constexpr const char* k_kernel_run_symbol = "cloud2csg_kernel_run";
inline constexpr int k_kernel_version = 3;
using KernelVersion = int (*)();
/// @throws Cancelled, and what the host throws
using KernelRun = void (*)(const KernelJob* job, const KernelHost* host, KernelResult* result);

}  // namespace cloud2csg::brep
