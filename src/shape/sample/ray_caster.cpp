#include "shape/sample/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cloud2csg/error.hpp"
#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

[[noreturn]] void fail_embree(const std::string& what) {
  throw Error({.expected = "ray casting cannot be set up: " + what});
}

/// Throws the error of the preceding calls.
void check(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (code != RTC_ERROR_NONE) fail_embree("Embree's error " + std::to_string(static_cast<int>(code)));
}

double squared_distance_to_segment(const Vector3d& a, const Vector3d& b, const Vector3d& point) {
  const Vector3d along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp((point - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (point - a - share * along).squaredNorm();
}

/// To a triangle, which may be degenerate.
double squared_distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& point) {
  const Vector3d normal = (b - a).cross(c - a);
  const bool is_over_face = normal.dot((b - a).cross(point - a)) >= 0.0 &&
                            normal.dot((c - b).cross(point - b)) >= 0.0 && normal.dot((a - c).cross(point - c)) >= 0.0;
  const double square = normal.squaredNorm();
  if (is_over_face && square > 0.0) {
    const double height = normal.dot(point - a);
    return height * height / square;
  }
  return std::min({squared_distance_to_segment(a, b, point), squared_distance_to_segment(b, c, point),
                   squared_distance_to_segment(c, a, point)});
}

}  // namespace

struct RayCaster::EmbreeScene {
#ifdef CLOUD2CSG_THREAD_SANITIZER
  // Embree's threads are TBB's, which the sanitizer does not see synchronise: not even when the program ends.
  RTCDevice device = rtcNewDevice("threads=1");
#else
  RTCDevice device = rtcNewDevice(nullptr);
#endif
  RTCScene scene = nullptr;

  EmbreeScene() = default;
  ~EmbreeScene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  EmbreeScene(EmbreeScene&&) = delete;
  EmbreeScene& operator=(EmbreeScene&&) = delete;
};

RayCaster::RayCaster(const TriangleMesh& mesh) : mesh_(&mesh), scene_(std::make_unique<EmbreeScene>()) {
  const AlignedBox box = bounds_of(mesh.vertices);
  middle_ = box.center();
  radius_ = std::max(0.5 * box.diagonal().norm(), std::numeric_limits<double>::min());
  if (scene_->device == nullptr) fail_embree("no device");
  scene_->scene = rtcNewScene(scene_->device);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* const vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 3 * sizeof(float), mesh.vertices.size());
  void* const triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  3 * sizeof(std::uint32_t), mesh.triangles.size());
  if (vertices != nullptr && triangles != nullptr) {
    auto* coordinate = static_cast<float*>(vertices);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      const Eigen::Vector3f vertex = ((mesh.vertices[i] - middle_) / radius_).cast<float>();
      coordinate = std::copy_n(vertex.data(), 3, coordinate);
    }
    auto* index = static_cast<std::uint32_t*>(triangles);
    for (const auto& triangle : mesh.triangles) index = std::copy_n(triangle.data(), 3, index);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
  check(scene_->device);
}

RayCaster::~RayCaster() = default;

std::optional<RayHit> RayCaster::first_hit(const Ray& ray) const {
  const Eigen::Vector3f origin = ((ray.origin - middle_) / radius_).cast<float>();
  const Eigen::Vector3f direction = ray.direction.cast<float>();
  RTCRayHit query{};
  query.ray.org_x = origin.x(), query.ray.org_y = origin.y(), query.ray.org_z = origin.z();
  query.ray.dir_x = direction.x(), query.ray.dir_y = direction.y(), query.ray.dir_z = direction.z();
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = std::numeric_limits<unsigned>::max();
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return hit_on(query.hit.primID, ray);
}

struct RayCaster::NearestTriangle {
  const RayCaster& caster;
  const Vector3d& point;
  double square = std::numeric_limits<double>::infinity();

  /// Tests a triangle whose box is near enough. Returns whether the search became narrower.
  static bool look_at(RTCPointQueryFunctionArguments* arguments) {
    auto& nearest = *static_cast<NearestTriangle*>(arguments->userPtr);
    const TriangleMesh& mesh = *nearest.caster.mesh_;
    const auto& [a, b, c] = mesh.triangles[arguments->primID];
    const double square = squared_distance(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], nearest.point);
    if (!(square < nearest.square)) return false;
    nearest.square = square;
    // Adds the error of single precision for the point and for vertices within radius 1.
    constexpr float k_rounding = 1e-6F;
    RTCPointQuery& query = *arguments->query;
    const float farthest = 1 + std::max({std::abs(query.x), std::abs(query.y), std::abs(query.z)});
    const auto radius = static_cast<float>(std::sqrt(square) / nearest.caster.radius_);
    query.radius = std::min(query.radius, radius + k_rounding * (radius + farthest));
    return true;
  }
};

double RayCaster::distance(const Vector3d& point) const {
  // From farther off, all triangles are equally distant in single precision, and each would be tested.
  constexpr double k_farthest = 1e15;
  const Vector3d place = ((point - middle_) / radius_).cwiseMax(-k_farthest).cwiseMin(k_farthest);
  RTCPointQuery query{.x = static_cast<float>(place.x()),
                      .y = static_cast<float>(place.y()),
                      .z = static_cast<float>(place.z()),
                      .time = 0,
                      .radius = std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  NearestTriangle nearest{.caster = *this, .point = point};
  rtcPointQuery(scene_->scene, &query, &context, NearestTriangle::look_at, &nearest);
  return std::sqrt(nearest.square);
}

/// Where a ray meets the plane of a triangle that it hits, clamped to the triangle (Moeller and Trumbore 1997).
std::optional<RayHit> RayCaster::hit_on(std::size_t triangle, const Ray& ray) const {
  const auto& [a, b, c] = mesh_->triangles[triangle];
  const Vector3d corner = mesh_->vertices[a];
  const Vector3d first = mesh_->vertices[b] - corner;
  const Vector3d second = mesh_->vertices[c] - corner;
  const Vector3d normal = first.cross(second);
  const double slope = -ray.direction.dot(normal);
  if (slope == 0.0) return std::nullopt;
  const Vector3d offset = ray.origin - corner;
  const Vector3d across = offset.cross(ray.direction);
  const double u = std::clamp(second.dot(across) / slope, 0.0, 1.0);
  const double v = std::clamp(-first.dot(across) / slope, 0.0, 1.0 - u);
  const Vector3d way = u * first + v * second - offset;
  const double range = way.dot(ray.direction);
  const Vector3d unit = normal.stableNormalized();
  if (!std::isfinite(range) || !unit.allFinite()) return std::nullopt;
  return RayHit{.range = range, .normal = slope > 0.0 ? unit : Vector3d(-unit)};
}

}  // namespace cloud2csg
