#include "render/ray_scene.hpp"

#if GRAINRAY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace grainray::picture {

namespace {

#if GRAINRAY_EMBREE >= 4
void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, nullptr); }
void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, nullptr); }
#else
void intersect(RTCScene scene, RTCRayHit& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}
void occluded(RTCScene scene, RTCRay& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
}
#endif

RTCRay embree_ray(const Ray& ray, float from) {
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = from;
    r.tfar = std::numeric_limits<float>::infinity();
    r.mask = ~0u;
    return r;
}

}  // namespace

struct RayScene::Impl {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = device ? rtcNewScene(device) : nullptr;
    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    void check() const {
        if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
            throw SimulationError(error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory while preparing a picture"
                                                                   : "Embree could not prepare a picture");
    }
    void add(const std::vector<Sphere>& spheres) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres.data(), 0, sizeof(Sphere), spheres.size());
        attach(geometry, 0);
    }
    void add(const Skin& skin, std::uint32_t part) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, skin.vertices.data(), 0, sizeof(Vec3f), skin.vertices.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, skin.triangles.data(), 0, 3 * sizeof(std::uint32_t), skin.triangles.size());
        attach(geometry, part);
    }

private:
    void attach(RTCGeometry geometry, std::uint32_t part) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, part);
        rtcReleaseGeometry(geometry);
    }
};

RayScene::RayScene(const std::vector<Sphere>& spheres, const std::vector<const Skin*>& skins) : impl_(std::make_unique<Impl>()), empty_(spheres.empty()) {
    static_assert(sizeof(Sphere) == 4 * sizeof(float) && sizeof(Vec3f) == 3 * sizeof(float));
    impl_->check();
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!spheres.empty()) impl_->add(spheres);  // Embree refuses an empty buffer
    for (std::uint32_t k = 0; k < skins.size(); ++k)
        if (!skins[k]->triangles.empty()) impl_->add(*skins[k], k + 1), empty_ = false;
    rtcCommitScene(impl_->scene);
    impl_->check();
}

RayScene::~RayScene() = default;

std::optional<RayScene::Hit> RayScene::first(const Ray& ray, float from) const {
    RTCRayHit r{embree_ray(ray, from), {}};
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(impl_->scene, r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return Hit{r.ray.tfar, r.hit.geomID, r.hit.primID, r.hit.u, r.hit.v};
}

bool RayScene::blocked(const Ray& ray) const {
    RTCRay r = embree_ray(ray, 0);
    occluded(impl_->scene, r);
    return r.tfar < 0;  // how Embree says yes
}

}  // namespace grainray::picture
