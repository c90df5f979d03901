#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "cloud2csg/error.hpp"
#include "cloud2csg/geometry.hpp"
#include "cloud2csg/input.hpp"
#include "core/base/parallel.hpp"
#include "core/primitive/surface_points.hpp"
#include "io/formats/formats.hpp"
#include "io/scanned_mesh.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_chunk_points = 4096;
constexpr std::uint64_t k_sampling_stage = 0x696e'7075'74;

Input read_cloud(const std::filesystem::path& file, const RunContext& run) {
  RawCloud raw = read_raw_cloud(file, run);
  Input input{.cloud = std::move(raw.cloud)};
  if (raw.normals_left_out) {
    input.warnings.push_back(
        fmt::format("{} normals are not finite or of length zero: all normals are left out.", raw.invalid_normals));
  }
  if (raw.invalid_points > 0) {
    input.warnings.push_back(
        fmt::format("{} of {} points are left out: a coordinate is not finite, or a normal has no direction.",
                    raw.invalid_points, raw.invalid_points + input.cloud.size()));
  }
  return input;
}

/// Most mesh files hold single-precision numbers.
bool is_in_single_precision(const TriangleMesh& mesh) {
  return std::ranges::all_of(std::array{&mesh.vertices.x, &mesh.vertices.y, &mesh.vertices.z}, [](const auto* axis) {
    return std::ranges::all_of(*axis, [](double x) { return x == static_cast<double>(static_cast<float>(x)); });
  });
}

void warn_of_coarse_corners(const TriangleMesh& mesh, std::vector<std::string>& warnings) {
  constexpr double k_coarse = 1e-4;  // in diagonals: a tenth of the least tolerance
  const AlignedBox box = bounds_of(mesh.vertices);
  const double farthest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const double step = farthest * static_cast<double>(std::numeric_limits<float>::epsilon());
  if (step <= k_coarse * box.diagonal().norm() || !is_in_single_precision(mesh)) return;
  warnings.push_back(
      fmt::format("The mesh is in single precision and so far from the origin that its coordinates have steps of "
                  "{:.2g}: move it to the origin before writing it, or give a cloud.",
                  step));
}

/// Points of the mesh and the warnings.
Input points_of(const TriangleMesh& mesh, std::vector<std::string> warnings, const InputOptions& options,
                const RunContext& run) {
  validate(options);
  std::optional<ScannedPoints> scan = scanned_points(mesh, options.seed, run);
  if (!scan) return {.cloud = sample_mesh(mesh, options, run), .is_exact = true, .warnings = std::move(warnings)};
  warnings.push_back(
      fmt::format("The mesh was made from a scan: its vertices have a noise of {:.2g} and are taken as a point cloud.",
                  scan->noise));
  return {.cloud = std::move(scan->cloud), .warnings = std::move(warnings)};
}

Input read_and_sample(const std::filesystem::path& file, const InputOptions& options, const RunContext& run) {
  MendedMesh mended = mend_mesh(read_mesh(file), run);
  try {
    Input input = points_of(mended.mesh, std::move(mended.warnings), options, run);
    warn_of_coarse_corners(mended.mesh, input.warnings);
    input.mesh = std::move(mended.mesh);
    return input;
  } catch (const Error& error) {
    if (error.parts().where != "mesh") throw;
    Error::Parts parts = error.parts();
    parts.file = file.string();
    throw Error(std::move(parts));
  }
}

}  // namespace

PointCloud sample_mesh(const TriangleMesh& mesh, const InputOptions& options, const RunContext& run) {
  validate(options);
  const TriangleSampler sampler(mesh.vertices, mesh.triangles);
  if (!(sampler.area() > 0.0)) {
    throw Error({.where = "mesh", .expected = "expected triangles with area, found none"});
  }
  PointCloud cloud{.positions = Points(options.mesh_points), .normals = Points(options.mesh_points)};
  for_each_index((cloud.size() + k_chunk_points - 1) / k_chunk_points, run, [&](std::size_t chunk) {
    RandomStream random(options.seed, k_sampling_stage, chunk);
    const std::size_t end = std::min(cloud.size(), (chunk + 1) * k_chunk_points);
    for (std::size_t i = chunk * k_chunk_points; i < end; ++i) {
      const TriangleSampler::Draw draw = sampler.draw(random);
      cloud.positions.set(i, draw.position);
      cloud.normals.set(i, sampler.normal(draw.triangle));
    }
  });
  run.report("read", cloud.size(), cloud.size(), "points");
  return cloud;
}

PointCloud sample_mesh_surface(const TriangleMesh& mesh, const SampleOptions& options, const RunContext& run) {
  validate(options);
  if (options.density > 0 || options.normal_noise_deg > 0) {
    throw invalid_option(options.density > 0 ? "density" : "normal_noise_deg",
                         "works only for models, and this is a mesh", "give `count` and `noise`");
  }
  PointCloud cloud = sample_mesh(mesh, {.mesh_points = options.count, .seed = options.seed}, run);
  return options.noise > 0 ? with_noise(std::move(cloud), options.noise, options.seed) : cloud;
}

Input read_cloud_or_mesh(const std::filesystem::path& file, const InputOptions& options, const RunContext& run) {
  const FileKind kind = format_to_read(file, {FileKind::cloud, FileKind::mesh}).kind;
  return kind == FileKind::mesh ? read_and_sample(file, options, run) : read_cloud(file, run);
}

}  // namespace cloud2csg
