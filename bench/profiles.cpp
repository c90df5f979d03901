// How often random extrusions and revolutions of lines and arcs come back from points: with the right number of
// segments and the right solid.
//   bench_profiles [--count N] [--noise SHARE] [--points N] [--keep FOLDER]
// With --keep, each result with another number of segments is written as a model, beside its truth.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "cloud2csg/compare.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/parallel.hpp"
#include "core/base/random.hpp"
#include "core/primitive/profile.hpp"
#include "run_main.hpp"

namespace cloud2csg::bench {
namespace {

using Eigen::Vector2d;

constexpr double k_least_iou = 0.98;

struct Options {
  std::size_t count = 200, points = 40'000;
  double noise = 0;  ///< in diagonals
  std::filesystem::path keep = {};
};

Options read_options(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--count") options.count = std::stoul(argv[i + 1]);
    if (name == "--points") options.points = std::stoul(argv[i + 1]);
    if (name == "--noise") options.noise = std::stod(argv[i + 1]);
    if (name == "--keep") options.keep = argv[i + 1];
  }
  return options;
}

/// Whether a person could count the segments: none is short, and none goes on as the one before.
bool is_clear(const Profile& profile) {
  constexpr double k_shortest = 0.15;
  constexpr double k_least_turn = 0.25;  // radians
  for (const ClosedPath& path : profile.paths) {
    const std::vector<ProfileSegment> segments = segments_of(path);
    for (std::size_t k = 0; k < segments.size() && !is_circle(segments); ++k) {
      const ProfileSegment& s = segments[k];
      const Vector2d before = s.normal(1);
      const Vector2d after = segments[(k + 1) % segments.size()].normal(0);
      if (s.length() < k_shortest || std::abs(std::atan2(cross(before, after), before.dot(after))) < k_least_turn) {
        return false;
      }
    }
  }
  try {
    validate_profile(profile);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A star of lines and arcs, 0.4 to 1 from the origin, some with a round hole.
Profile any_profile(RandomStream& random) {
  while (true) {
    const std::size_t corners = 3 + random.below(7);
    ClosedPath path;
    for (std::size_t k = 0; k < corners; ++k) {
      const double angle =
          2 * std::numbers::pi * (static_cast<double>(k) + random.uniform(0, 0.5)) / static_cast<double>(corners);
      const double bulge = random.chance(0.6) ? 0.0 : random.uniform(0.15, 0.8) * (random.chance(0.3) ? -1 : 1);
      path.push_back({.point = random.uniform(0.4, 1) * Vector2d(std::cos(angle), std::sin(angle)), .bulge = bulge});
    }
    Profile profile{.paths = {path}};
    if (random.chance(0.3)) {
      const double radius = random.uniform(0.08, 0.2);
      profile.paths.push_back({{.point = {-radius, 0}, .bulge = 1}, {.point = {radius, 0}, .bulge = 1}});
    }
    if (is_clear(profile)) return profile;
  }
}

Pose any_pose(RandomStream& random, double far) {
  return {.position = far * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
          .orientation =
              Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized()};
}

Shape any_extrusion(RandomStream& random) {
  return Extrusion{.profile = any_profile(random), .height = random.uniform(0.3, 1.5)};
}

Profile any_profile_beside_the_axis(RandomStream& random) {
  Profile profile = any_profile(random);
  const double shift = random.uniform(0.2, 1) - bounds_of(profile).min().x();
  for (ClosedPath& path : profile.paths) {
    for (PathCorner& corner : path) corner.point.x() += shift;
  }
  return profile;
}

Shape any_revolution(RandomStream& random) {
  return Revolution{any_profile_beside_the_axis(random)};
}

Shape any_sector(RandomStream& random) {
  const double angle = random.uniform(30, 330);
  return Revolution{.profile = any_profile_beside_the_axis(random), .angle_deg = angle};
}

/// Its profile begins and ends on the axis.
Shape any_solid_around_the_axis(RandomStream& random) {
  while (true) {
    ClosedPath path{{.point = {0, -random.uniform(0.4, 1)}}};
    const std::size_t corners = 2 + random.below(4);
    for (std::size_t k = 0; k < corners; ++k) {
      const double angle =
          std::numbers::pi * ((static_cast<double>(k) + random.uniform(0.1, 0.6)) / static_cast<double>(corners) - 0.5);
      const double bulge = random.chance(0.6) ? 0.0 : random.uniform(0.15, 0.8) * (random.chance(0.3) ? -1 : 1);
      path.push_back({.point = random.uniform(0.4, 1) * Vector2d(std::cos(angle), std::sin(angle)), .bulge = bulge});
    }
    path.push_back({.point = {0, random.uniform(0.4, 1)}});
    const Profile profile{.paths = {path}};
    if (is_clear(profile) && bounds_of(profile).min().x() > -1e-9) return Revolution{profile};
  }
}

/// Segments of a solid as a profile; a circle is one. A box has four, a cylinder or torus one, or as turned ones four.
std::vector<std::size_t> segment_counts(const Primitive& primitive) {
  if (const Profile* const profile = profile_of(primitive.shape)) return {count_segments(*profile)};
  if (std::holds_alternative<Box>(primitive.shape)) return {4};
  if (std::holds_alternative<Cylinder>(primitive.shape)) return {1, 4};
  if (std::holds_alternative<Cone>(primitive.shape)) return {3, 4};
  return {1};
}

bool has_right_counts(const Model& truth, const Extraction& result) {
  std::vector<PrimitiveIndex> left = primitives_of(result.tree());
  if (left.size() != truth.primitives.size()) return false;
  for (const Primitive& solid : truth.primitives) {
    const std::size_t wanted = segment_counts(solid)[0];
    const auto fits = [&](PrimitiveIndex p) {
      const std::vector<std::size_t> counts = segment_counts(result.model.primitives[p]);
      return std::ranges::find(counts, wanted) != counts.end();
    };
    const auto found = std::ranges::find_if(left, fits);
    if (found == left.end()) return false;
    left.erase(found);
  }
  return true;
}

/// Whether each segment of each solid has enough points of the exact cloud, so that one can tell it.
bool shows_all_segments(const Model& model, const PointCloud& cloud) {
  constexpr std::size_t k_enough = 50;
  constexpr double k_near = 1e-6;
  for (const Primitive& solid : model.primitives) {
    const auto* extrusion = std::get_if<Extrusion>(&solid.shape);
    for (const ProfileSegment& segment : segments_of(*profile_of(solid.shape))) {
      if (extrusion == nullptr && segment.is_on_axis()) continue;
      std::size_t count = 0;
      for (std::size_t i = 0; i < cloud.size() && count < k_enough; ++i) {
        const Eigen::Vector3d local = solid.pose.to_local(cloud.positions[i]);
        if (extrusion != nullptr && std::abs(local.z()) > 0.5 * extrusion->height - k_near) continue;
        const Vector2d place =
            extrusion != nullptr ? Vector2d(local.head<2>()) : Vector2d(local.head<2>().norm(), local.z());
        count += (nearest(segment, place) - place).norm() < k_near ? 1 : 0;
      }
      if (count < k_enough) return false;
    }
  }
  return true;
}

struct Outcome {
  bool is_counted = false, is_right = false;
  double iou = 0;
};

Outcome outcome_of(const Model& truth, PointCloud cloud, const Options& options, const std::string& name) {
  cloud = with_noise(cloud, options.noise * bounds_of(cloud.positions).diagonal().norm());
  try {
    RunContext alone;
    alone.threads = 1;
    const Extraction result = reconstruct(cloud, {}, alone);
    const Shape3d a{.model = truth};
    const Shape3d b{.model = result.model};
    const double iou = compare(a, b, {.resolution = 96, .surface_samples = 1000}).intersection_over_union.value_or(0);
    const Outcome outcome{.is_counted = has_right_counts(truth, result), .is_right = iou >= k_least_iou, .iou = iou};
    if (!options.keep.empty() && !outcome.is_counted) {
      std::filesystem::create_directories(options.keep);
      write_model(options.keep / (name + "_truth.json"), truth);
      write_model(options.keep / (name + "_result.json"), result.model);
    }
    return outcome;
  } catch (const Error&) {
    return {};
  }
}

struct Kind {
  const char* name;
  Shape (*any)(RandomStream&);
  bool is_pair = false;
};

constexpr std::array<Kind, 6> k_kinds{{{"extrusion", any_extrusion},
                                       {"revolution", any_revolution},
                                       {"sector", any_sector},
                                       {"revolution around its axis", any_solid_around_the_axis},
                                       {"extrusion and another solid", any_extrusion, true},
                                       {"revolution and another solid", any_revolution, true}}};

std::string file_name_of(const Kind& kind) {
  std::string name = kind.name;
  std::ranges::replace(name, ' ', '_');
  return name;
}

/// One solid, or two of which the second is added or taken away.
Model any_solids(const Kind& kind, std::uint64_t seed) {
  RandomStream random(seed);
  Model model{.primitives = {{.id = "first", .shape = kind.any(random), .pose = any_pose(random, 0)}},
              .tree = CsgTree::leaf(0)};
  if (!kind.is_pair) return model;
  const auto another = random.chance(0.5) ? any_revolution : any_extrusion;
  model.primitives.push_back({.id = "second", .shape = another(random), .pose = any_pose(random, 0.6)});
  model.tree =
      random.chance(0.5) ? unite(CsgTree::leaf(0), CsgTree::leaf(1)) : subtract(CsgTree::leaf(0), CsgTree::leaf(1));
  return model;
}

Outcome outcome_of(const Kind& kind, const Options& options, std::uint64_t seed) {
  constexpr std::uint64_t k_tries = 1000;
  for (std::uint64_t t = 0; t < k_tries; ++t) {
    const Model truth = any_solids(kind, k_tries * seed + t);
    PointCloud cloud = sample_surface(truth, {.count = options.points, .seed = seed});
    if (!shows_all_segments(truth, cloud)) continue;
    return outcome_of(truth, std::move(cloud), options, fmt::format("{}_{}", file_name_of(kind), seed));
  }
  return {};
}

int run(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  fmt::print("{} solids a row, {} points, noise {} % of the diagonal; right: IoU >= {}\n\n", options.count,
             options.points, 100 * options.noise, k_least_iou);
  fmt::print("| solids | right number of segments | right | mean IoU |\n|---|---:|---:|---:|\n");
  for (const Kind& kind : k_kinds) {
    std::vector<Outcome> outcomes(options.count);
    for_each_index(options.count, {}, [&](std::size_t k) { outcomes[k] = outcome_of(kind, options, k); });
    double counted = 0;
    double right = 0;
    double iou = 0;
    for (const Outcome& outcome : outcomes) {
      counted += outcome.is_counted ? 1 : 0;
      right += outcome.is_right ? 1 : 0;
      iou += outcome.iou;
    }
    const auto n = static_cast<double>(options.count);
    fmt::print("| {} | {:.1f} % | {:.1f} % | {:.4f} |\n", kind.name, 100 * counted / n, 100 * right / n, iou / n);
  }
  return 0;
}

}  // namespace
}  // namespace cloud2csg::bench

int main(int argc, char** argv) {
  return cloud2csg::bench::run_main(argc, argv, cloud2csg::bench::run);
}
