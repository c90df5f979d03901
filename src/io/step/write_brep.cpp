#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "core/fields/tree_volume.hpp"
#include "io/step/host.hpp"
#include "io/step/kernel_solids.hpp"
#include "io/step/load_kernel.hpp"
#include "io/step/step_text.hpp"
#include "shape/mesh/model_extent.hpp"

namespace cloud2csg {
namespace {

using brep::KernelFormat;
using brep::KernelJob;
using brep::KernelResult;

const brep::Kernel& kernel_for(const std::filesystem::path& file) {
  const brep::Kernel& kernel = brep::load_kernel();
  if (kernel.run != nullptr) return kernel;
  throw Error({.file = file.string(),
               .expected = "exact solids need OpenCASCADE, which this cloud2csg lacks: " + kernel.missing,
               .remedy = kernel.remedy});
}

// Numbers of the names that a job's tokens represent.
constexpr std::size_t k_part = 0;
constexpr std::size_t k_assembly = 1;
constexpr std::size_t k_first_primitive = 2;

std::vector<std::string> names_in_file(const std::filesystem::path& file, const PrimitiveSet& primitives,
                                       const BrepOptions& options) {
  const std::string part = options.name.empty() ? file.stem().string() : options.name;
  std::vector<std::string> names{part, part + " assembly"};
  for (const Primitive& primitive : primitives) names.push_back(primitive.id);
  return names;
}

KernelJob job_of(const Model& model, const AlignedBox& extent, const BrepOptions& options, KernelFormat format) {
  KernelJob job;
  job.plan = brep::plan_solid(tree_of(model));
  job.format = format;
  job.levels = brep::levels_of(job.plan);
  job.frame = brep::work_frame(extent);
  job.extent = brep::to_kernel(extent, job.frame);
  job.size = job.extent.diagonal().norm();
  job.volume_tolerance = options.volume_tolerance;
  job.program = "cloud2csg " CLOUD2CSG_VERSION;
  job.part_name = brep::name_token(k_part);
  job.assembly_name = brep::name_token(k_assembly);
  for (std::size_t i = 0; i < model.primitives.size(); ++i)
    job.names.push_back(brep::name_token(k_first_primitive + i));
  if (options.with_primitives) job.components = primitives_of(*model.tree);
  return job;
}

/// Keeps a message readable on one line.
std::string shortened(std::string text) {
  constexpr std::size_t k_longest = 200;
  if (text.size() <= k_longest) return text;
  std::size_t end = k_longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not within a character
  return text.substr(0, end) + "...";
}

BrepReport report_of(const KernelResult& result, const KernelJob& job, const Model& model) {
  BrepReport report{.volume = result.volume,
                    .is_valid = result.is_valid,
                    .solids = result.solids,
                    .faces = result.faces,
                    .healed_faces = result.healed_faces};
  for (const PrimitiveIndex index : primitives_of(*model.tree)) {
    if (!brep::has_exact_surfaces(model.primitives[index])) report.faceted.push_back(index);
  }
  for (const brep::KernelFailure& failure : result.failures) {
    report.failed.push_back(
        {.node = shortened(to_text(tree_of(job.plan, failure.node), model.primitives)), .reason = failure.reason});
  }
  return report;
}

VolumeEstimate volume_within(const Model& model, const AlignedBox& extent, const RunContext& run) {
  constexpr int k_levels = 8;
  const AlignedBox own = bounds_of(model);
  if (own.isEmpty()) return {};
  return tree_volume(model, own.intersection(extent), k_levels, run);
}

struct Made {
  KernelResult result;
  BrepReport report;
};

Made make(const std::filesystem::path& file, const KernelJob& job, const Model& model, const AlignedBox& extent,
          const BrepOptions& options, const RunContext& run) {
  const brep::ModelHost host(job, model, extent, options, run, names_in_file(file, model.primitives, options));
  Made made;
  KernelResult& result = made.result;
  kernel_for(file).run(&job, &host, &result);
  if (result.error.empty() && result.is_empty) result.error = "the solid is empty";
  if (!result.error.empty()) {
    throw Error({.file = file.string(), .expected = result.error});
  }
  made.report = report_of(result, job, model);
  const VolumeEstimate estimate = volume_within(model, extent, run);
  made.report.tree_volume = estimate.volume;
  made.report.tree_volume_error = estimate.error;
  made.report.cut_at = cut_at(model, extent);
  return made;
}

BrepReport write(const std::filesystem::path& file, const Model& model, const BrepOptions& options, KernelFormat format,
                 const RunContext& run) {
  validate(options);
  require_brep(file);
  const AlignedBox extent = model_extent(model);
  KernelJob job = job_of(model, extent, options, format);
  const ScratchFile scratch;
  job.file = scratch.path();
  Made made = make(file, job, model, extent, options, run);
  write_text_file(file, read_text_file(scratch.path()));
  return std::move(made.report);
}

}  // namespace

bool BrepReport::is_exact(const BrepOptions& options) const {
  return is_valid && failed.empty() && faceted.empty() && volume_difference() <= options.volume_tolerance;
}

double BrepReport::volume_difference() const {
  const double difference = std::abs(volume - tree_volume);
  return difference == 0 ? 0 : difference / std::max(tree_volume, 1e-300);
}

bool has_brep() {
  return brep::load_kernel().run != nullptr;
}

bool is_brep_built_in() {
  return brep::is_kernel_built_in();
}

BrepSupport brep_support() {
  const brep::Kernel& kernel = brep::load_kernel();
  return {.is_built_in = is_brep_built_in(),
          .lacks_opencascade = kernel.lacks_opencascade,
          .module = kernel.file,
          .fault = kernel.missing,
          .remedy = kernel.remedy};
}

void require_brep(const std::filesystem::path& file) {
  (void)kernel_for(file);
}

BrepReport write_step(const std::filesystem::path& file, const Model& model, const BrepOptions& options,
                      const RunContext& run) {
  return write(file, model, options, KernelFormat::step, run);
}

BrepReport write_brep(const std::filesystem::path& file, const Model& model, const BrepOptions& options,
                      const RunContext& run) {
  return write(file, model, options, KernelFormat::brep, run);
}

BrepMesh mesh_brep(const Model& model, const BrepOptions& options, const RunContext& run) {
  validate(options);
  require_brep({});
  const AlignedBox extent = model_extent(model);
  KernelJob job = job_of(model, extent, options, KernelFormat::mesh);
  job.mesh_deviation = options.mesh_deviation * job.size;
  Made made = make({}, job, model, extent, options, run);
  TriangleMesh mesh{.vertices = {}, .triangles = std::move(made.result.mesh.triangles)};
  for (std::size_t i = 0; i < made.result.mesh.vertices.size(); ++i) {
    mesh.vertices.push_back(job.frame.scale * made.result.mesh.vertices[i] + job.frame.offset);
  }
  return {.mesh = std::move(mesh), .report = std::move(made.report)};
}

}  // namespace cloud2csg
