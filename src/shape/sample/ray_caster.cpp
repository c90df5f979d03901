#include "shape/sample/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

[[noreturn]] void fail_embree(const std::string& what) {
  throw Error({.file = {}, .where = {}, .expected = "ray casting cannot be set up: " + what, .remedy = {}});
}

/// Throws what went wrong in the calls before.
void check(RTCDevice device) {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  if (code != RTC_ERROR_NONE) fail_embree("Embree's error " + std::to_string(static_cast<int>(code)));
}

}  // namespace

struct RayCaster::EmbreeScene {
  RTCDevice device = rtcNewDevice(nullptr);
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

/// Where a ray meets the plane of a triangle that it is known to hit, brought back onto the triangle where rounding
/// puts it beside (Moeller and Trumbore 1997).
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
