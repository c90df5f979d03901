// Errors of prepared clouds (noise, outliers, normals) for the shipped models and the meshes given as arguments.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <string>
#include <unordered_map>
#include <vector>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/input.hpp"
#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"
#include "core/geometry/subset.hpp"

namespace {

namespace c2c = cloud2csg;
using Eigen::Vector3d;

constexpr std::size_t k_points = 30'000;
const c2c::RunContext k_run{.threads = 2};

c2c::PointCloud truth(const std::filesystem::path& file, std::size_t points) {
  if (file.extension() != ".json")
    return c2c::sample_mesh(c2c::mend_mesh(c2c::read_mesh(file)).mesh, {.mesh_points = points});
  const c2c::Model model = c2c::read_model(file);
  return c2c::sample_surface(model, {.count = points});
}

c2c::PointCloud scan(const std::filesystem::path& file, std::size_t points) {
  const c2c::ScanOptions options{.count = points, .with_normals = true};
  if (file.extension() != ".json") return c2c::scan_mesh(c2c::read_mesh(file), options, k_run);
  const c2c::Model model = c2c::read_model(file);
  return c2c::scan_model(model, options, k_run);
}

void print_scale(const std::vector<std::filesystem::path>& files) {
  fmt::print("\nScale: estimated noise / true noise, {} points\n\n| model |", k_points);
  constexpr std::array k_noises{0.0005, 0.001, 0.002, 0.005, 0.01};
  for (const double noise : k_noises) fmt::print(" {} % |", 100 * noise);
  fmt::print(" none, of the diagonal |\n");
  for (const std::filesystem::path& file : files) {
    const c2c::PointCloud exact = truth(file, k_points);
    const double diagonal = c2c::bounds_of(exact.positions).diagonal().norm();
    fmt::print("| {} |", file.filename().string());
    for (const double noise : k_noises) {
      const c2c::Scale scale = c2c::estimate_scale(with_noise(exact, noise * diagonal), k_run);
      fmt::print(" {:.2f} |", scale.noise / (noise * diagonal));
    }
    const c2c::Scale scale = c2c::estimate_scale(exact, k_run);
    fmt::print(" {:.1e} (spacing {:.4f}, diagonal {:.3f}) |\n", scale.noise / diagonal, scale.spacing / diagonal,
               scale.diagonal / diagonal);
  }
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// CPU time of all threads: other programs do not count.
double cpu_seconds_of(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct NormalErrors {
  double right = 0.0;       ///< share on the same side as the true normals
  double median_deg = 0.0;  ///< median angle between the unoriented normals
};

NormalErrors compare_normals(const c2c::Points& normals, const c2c::Points& exact) {
  NormalErrors errors;
  std::vector<double> angles;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double cosine = normals[i].dot(exact[i]);
    errors.right += cosine > 0.0 ? 1.0 / static_cast<double>(normals.size()) : 0.0;
    angles.push_back(std::acos(std::min(1.0, std::abs(cosine))) * 180.0 / std::numbers::pi);
  }
  std::nth_element(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2), angles.end());
  errors.median_deg = angles[angles.size() / 2];
  return errors;
}

void print_normals(const std::vector<std::filesystem::path>& files, double noise) {
  fmt::print("\nNormals: {} points, noise {} % of the diagonal\n\n", k_points, 100 * noise);
  fmt::print(
      "| model | oriented rightly | median angle | bodies | doubtful | s | lost by prepare_cloud | s "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : files) {
    const c2c::PointCloud exact = truth(file, k_points);
    c2c::PointCloud cloud = with_noise(exact, noise * c2c::bounds_of(exact.positions).diagonal().norm());
    cloud.normals = {};
    const c2c::Scale scale = c2c::estimate_scale(cloud, k_run);
    c2c::EstimatedNormals found;
    const double seconds = seconds_of([&] { found = c2c::estimate_normals(cloud, scale, k_run); });
    const NormalErrors errors = compare_normals(found.normals, exact.normals);
    c2c::PreparedCloud prepared;
    const double all = seconds_of([&] { prepared = c2c::prepare_cloud(cloud, {}, k_run); });
    fmt::print("| {} | {:.3f} % | {:.2f} | {} | {} | {:.2f} | {} | {:.2f} |\n", file.filename().string(),
               100.0 * errors.right, errors.median_deg, found.bodies, found.doubtful.size(), seconds,
               cloud.size() - prepared.cloud.size(), all);
  }
}

/// Scans with the sensor positions.
void print_scans(const std::vector<std::filesystem::path>& files) {
  fmt::print("\nScans: {} points with sensor positions and all defects of a scanner\n\n", k_points);
  fmt::print("| model | oriented rightly | median angle | doubtful | left out | s |\n|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : files) {
    const c2c::PointCloud cloud = scan(file, k_points);
    // Cleaning ignores normals, so the same points remain without them.
    const c2c::CleanCloud cleaned = c2c::clean_cloud(cloud, c2c::estimate_scale(cloud, k_run), {}, k_run);
    const c2c::PointCloud known = c2c::without_points(cleaned.cloud, cleaned.doubted);
    c2c::PointCloud plain = known;
    plain.normals = {};
    c2c::EstimatedNormals found;
    const double seconds =
        seconds_of([&] { found = c2c::estimate_normals(plain, c2c::estimate_scale(plain, k_run), k_run); });
    const NormalErrors errors = compare_normals(found.normals, known.normals);
    fmt::print("| {} | {:.3f} % | {:.2f} | {} | {} | {:.2f} |\n", file.filename().string(), 100.0 * errors.right,
               errors.median_deg, found.doubtful.size(), cloud.size() - known.size(), seconds);
  }
}

/// Whether each place is farther than `distance` from all points, which sample a surface densely.
std::vector<char> far_from(const c2c::Points& surface, const c2c::Points& places, double distance) {
  const std::size_t count = surface.size();
  std::vector<char> is_far(places.size(), 1);
  const double width = distance;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
  const auto cell_of = [&](const Vector3d& place, const Eigen::Vector3i& offset) {
    const Eigen::Vector3i cell = (place / width).array().floor().cast<int>().matrix() + offset;
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) key = key << 21U | (static_cast<std::uint32_t>(cell[axis]) & 0x1f'ffffU);
    return key;
  };
  for (std::uint32_t i = 0; i < count; ++i) cells[cell_of(surface[i], {0, 0, 0})].push_back(i);
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (int n = 0; n < 27 && is_far[p] != 0; ++n) {
      const auto cell = cells.find(cell_of(places[p], {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}));
      if (cell == cells.end()) continue;
      for (const std::uint32_t i : cell->second) {
        if ((surface[i] - places[p]).squaredNorm() <= distance * distance) is_far[p] = 0;
      }
    }
  }
  return is_far;
}

/// Uniform in a box enlarged by 10 %.
c2c::Points outliers_around(const c2c::AlignedBox& box, std::size_t count) {
  c2c::RandomStream random(3);
  c2c::Points outliers;
  for (std::size_t i = 0; i < count; ++i) {
    Vector3d place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = random.uniform(-0.55, 0.55);
    outliers.push_back(box.center() + place.cwiseProduct(box.sizes()));
  }
  return outliers;
}

void print_cleaning(const std::vector<std::filesystem::path>& files, double noise) {
  fmt::print("\nCleaning: {} points and as many outliers in a box 10 % larger, noise {} %\n\n", k_points, 100 * noise);
  fmt::print(
      "| model | outliers beyond 5 noise left out | estimated noise, spacing | points lost | lost when clean | s "
      "|\n|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : files) {
    const c2c::PointCloud dense = truth(file, 20 * k_points);
    const c2c::PointCloud exact = truth(file, k_points);
    const c2c::AlignedBox box = c2c::bounds_of(exact.positions);
    const double sigma = noise * box.diagonal().norm();
    c2c::PointCloud cloud = with_noise(exact, sigma);
    cloud.normals = {};
    const c2c::CleanCloud alone = c2c::clean_cloud(cloud, c2c::estimate_scale(cloud, k_run), {}, k_run);
    const c2c::Points outliers = outliers_around(box, k_points);
    const std::vector<char> is_far = far_from(dense.positions, outliers, 5.0 * sigma);
    // The normals mark the kinds of points.
    cloud.normals = c2c::Points(k_points);
    for (std::size_t i = 0; i < outliers.size(); ++i) {
      cloud.positions.push_back(outliers[i]);
      cloud.normals.push_back(is_far[i] != 0 ? Vector3d::UnitX() : Vector3d::UnitY());
    }
    c2c::CleanCloud clean;
    const c2c::Scale scale = c2c::estimate_scale(cloud, k_run);
    const double seconds = seconds_of([&] { clean = c2c::clean_cloud(cloud, scale, {}, k_run); });
    const c2c::PointCloud sure = c2c::without_points(clean.cloud, clean.doubted);
    const auto left = [](const std::vector<double>& marks) {
      return static_cast<double>(std::count(marks.begin(), marks.end(), 1.0));
    };
    const auto far = static_cast<double>(std::count(is_far.begin(), is_far.end(), 1));
    const double kept = static_cast<double>(sure.size()) - left(sure.normals.x) - left(sure.normals.y);
    fmt::print("| {} | {:.2f} % | {:.2f} x true, {:.4f} | {:.2f} % | {:.3f} % | {:.2f} |\n", file.filename().string(),
               100.0 - 100.0 * left(sure.normals.x) / far, scale.noise / sigma, scale.spacing / box.diagonal().norm(),
               100.0 - 100.0 * kept / k_points,
               100.0 - 100.0 * static_cast<double>(alone.cloud.size() - alone.doubted.size()) / k_points, seconds);
  }
}

void print_speed(const std::filesystem::path& file) {
  c2c::PointCloud cloud = truth(file, 100'000);
  cloud = with_noise(cloud, 0.002 * c2c::bounds_of(cloud.positions).diagonal().norm());
  const c2c::WindingField field(cloud.positions, cloud.normals, c2c::point_areas(cloud));
  const c2c::AlignedBox box = c2c::bounds_of(cloud.positions);
  c2c::RandomStream random(5);
  c2c::Points places(20'000);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places.set(i, {random.uniform(box.min().x(), box.max().x()), random.uniform(box.min().y(), box.max().y()),
                   random.uniform(box.min().z(), box.max().z())});
  }
  double sum = 0.0;
  const double seconds = seconds_of([&] {
    for (std::size_t i = 0; i < places.size(); ++i) sum += field.at(places[i]);
  });
  double worst = 0.0;
  for (std::size_t i = 0; i < 300; ++i) worst = std::max(worst, std::abs(field.at(places[i]) - field.exact(places[i])));
  fmt::print("\nWinding number, 100 000 points: {:.2f} us a place, largest error of 300 {:.4f}, mean {:.3f}\n",
             1e6 * seconds / static_cast<double>(places.size()), worst, sum / static_cast<double>(places.size()));
  fmt::print("\n100 000 points, seconds of processor time\n\n");
  fmt::print("| normals | scale | cleaning | normals | prepare_cloud in all |\n|---|---|---|---|---|\n");
  for (const bool has_normals : {true, false}) {
    if (!has_normals) cloud.normals = {};
    c2c::Scale scale;
    const double measuring = cpu_seconds_of([&] { scale = c2c::estimate_scale(cloud, k_run); });
    const double cleaning = cpu_seconds_of([&] { (void)c2c::clean_cloud(cloud, scale, {}, k_run); });
    const double normals = cpu_seconds_of([&] {
      if (has_normals) {
        (void)c2c::check_normals(cloud, scale, k_run);
      } else {
        (void)c2c::estimate_normals(cloud, scale, k_run);
      }
    });
    const double all = cpu_seconds_of([&] { (void)c2c::prepare_cloud(cloud, {}, k_run); });
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", has_normals ? "given" : "none", measuring, cleaning,
               normals, all);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"m0", "m1", "m2", "m3"}) {
    files.push_back(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / (std::string(name) + ".json"));
  }
  for (int i = 1; i < argc; ++i) files.emplace_back(argv[i]);
  print_scans(files);
  print_normals(files, 0.002);
  print_speed(files[0]);
  print_cleaning(files, 0.001);
  print_scale(files);
}
