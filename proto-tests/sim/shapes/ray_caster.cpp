#include "proto-tests/sim/shapes/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace liloc::sim {
namespace {

constexpr int kTileWidth = 4,
              kTileHeight = 4;  // one packet: neighbouring rays share most of their way down the tree
constexpr int kPacket = kTileWidth * kTileHeight;

struct Body {
  RTCScene scene = nullptr;
  RTCGeometry instance = nullptr;
  Eigen::Matrix3f R_map_body = Eigen::Matrix3f::Identity();
  std::vector<Material> materials;
};

RTCScene scene_of(RTCDevice device, const Mesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr) {
    rtcReleaseGeometry(geometry);
    return nullptr;
  }
  for (const auto& v : mesh.vertices) vertices = std::copy_n(v.data(), 3, vertices);
  for (const auto& t : mesh.triangles) indices = std::copy_n(t.data(), 3, indices);
  rtcCommitGeometry(geometry);
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

}  // namespace

struct RayCaster::Impl {
  explicit Impl(int thread_count) : threads(thread_count) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    for (const Body& body : bodies) {
      rtcReleaseGeometry(body.instance);
      rtcReleaseScene(body.scene);
    }
    if (top != nullptr) rtcReleaseScene(top);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void cast_tile(const Camera& camera, const Pose& T_map_camera, float range_m, int u0, int v0,
                 View& view) const;

  int threads;
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<Body> bodies;  // by instance number
};

RayCaster::RayCaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;
RayCaster::~RayCaster() = default;

Result<RayCaster> RayCaster::create(int threads) {
  auto impl = std::make_unique<Impl>(threads);
  impl->device =
      rtcNewDevice("threads=1,set_affinity=0");  // builds are small; the caller sets the thread budget
  if (impl->device == nullptr)
    return fail("Embree cannot start (error {}); check that libembree3 fits this machine",
                int{rtcGetDeviceError(nullptr)});
  impl->top = rtcNewScene(impl->device);
  rtcSetSceneFlags(impl->top, RTC_SCENE_FLAG_DYNAMIC);
  return RayCaster(std::move(impl));
}

Result<std::size_t> RayCaster::add(const Mesh& mesh) {
  Body body;
  body.scene = scene_of(impl_->device, mesh);
  if (body.scene == nullptr)
    return fail("Embree has no memory for {} triangles; simulate a smaller site", mesh.triangles.size());
  body.materials = mesh.materials;
  body.instance = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(body.instance, body.scene);
  rtcSetGeometryTimeStepCount(body.instance, 1);
  const std::size_t number = impl_->bodies.size();
  rtcAttachGeometryByID(impl_->top, body.instance, static_cast<unsigned>(number));
  impl_->bodies.push_back(std::move(body));
  move(number, Pose::Identity());
  return number;
}

void RayCaster::move(std::size_t number, const Pose& T_map_body) {
  Body& body = impl_->bodies[number];
  const Eigen::Matrix<float, 3, 4> columns = T_map_body.matrix().topRows<3>().cast<float>();
  body.R_map_body = columns.leftCols<3>();
  rtcSetGeometryTransform(body.instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcCommitGeometry(body.instance);
}

void RayCaster::commit() {
  rtcCommitScene(impl_->top);
}

void RayCaster::Impl::cast_tile(const Camera& camera, const Pose& T_map_camera, float range_m, int u0, int v0,
                                View& view) const {
  alignas(64) RTCRayHit16 packet;
  alignas(64) int valid[kPacket];
  const Eigen::Matrix3f R = T_map_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_map_camera.translation().cast<float>();
  for (int i = 0; i < kPacket; ++i) {
    const int u = u0 + i % kTileWidth, v = v0 + i / kTileWidth;
    valid[i] = u < camera.width && v < camera.height ? -1 : 0;
    const Eigen::Vector3f ray(static_cast<float>((u - camera.cx) / camera.fx),
                              static_cast<float>((v - camera.cy) / camera.fy), 1);
    const Eigen::Vector3f direction = R * ray;  // of depth 1, so that the ray's parameter is the depth
    packet.ray.org_x[i] = origin.x();
    packet.ray.org_y[i] = origin.y();
    packet.ray.org_z[i] = origin.z();
    packet.ray.dir_x[i] = direction.x();
    packet.ray.dir_y[i] = direction.y();
    packet.ray.dir_z[i] = direction.z();
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = range_m / ray.norm();
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0U;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, top, &context, &packet);
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const auto pixel = static_cast<std::size_t>((v0 + i / kTileWidth) * camera.width + u0 + i % kTileWidth);
    const Body& body = bodies[packet.hit.instID[0][i]];
    const Eigen::Vector3f normal =  // Embree leaves it in the body's axes
        (body.R_map_body * Eigen::Vector3f(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]))
            .normalized();
    const Eigen::Vector3f direction(packet.ray.dir_x[i], packet.ray.dir_y[i], packet.ray.dir_z[i]);
    view.depth_m[pixel] = packet.ray.tfar[i];
    view.cos_incidence[pixel] = std::abs(normal.dot(direction)) / direction.norm();
    view.material[pixel] = body.materials[packet.hit.primID[i]];
  }
}

View RayCaster::look(const Camera& camera, const Pose& T_map_camera, double range_m) const {
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  View view{std::vector<float>(pixels, 0.0F), std::vector<float>(pixels, 0.0F), std::vector<Material>(pixels)};
  const int rows = (camera.height + kTileHeight - 1) / kTileHeight;
  const auto band = [&](int first) {
    for (int row = first; row < rows; row += impl_->threads)
      for (int u = 0; u < camera.width; u += kTileWidth)
        impl_->cast_tile(camera, T_map_camera, static_cast<float>(range_m), u, row * kTileHeight, view);
  };
  std::vector<std::jthread> helpers;  // rows are dealt out in turn; no pixel is written twice
  for (int i = 1; i < impl_->threads; ++i) helpers.emplace_back(band, i);
  band(0);
  return view;
}

}  // namespace liloc::sim
