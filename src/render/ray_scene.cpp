#include "render/ray_scene.hpp"

#if GRAINRAY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>

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

RTCRay embree_ray(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
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
        void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size());
        if (to) std::copy(spheres.begin(), spheres.end(), static_cast<Sphere*>(to));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
};

RayScene::RayScene(const std::vector<Sphere>& spheres) : impl_(std::make_unique<Impl>()) {
    static_assert(sizeof(Sphere) == 4 * sizeof(float));
    impl_->check();
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    if (!spheres.empty()) impl_->add(spheres);  // Embree refuses an empty buffer
    rtcCommitScene(impl_->scene);
    impl_->check();
}

RayScene::~RayScene() = default;

std::optional<RayScene::Hit> RayScene::first(const Ray& ray) const {
    RTCRayHit r{embree_ray(ray), {}};
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(impl_->scene, r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return Hit{r.ray.tfar, r.hit.primID};
}

bool RayScene::blocked(const Ray& ray) const {
    RTCRay r = embree_ray(ray);
    occluded(impl_->scene, r);
    return r.tfar < 0;  // how Embree says yes
}

}  // namespace grainray::picture
