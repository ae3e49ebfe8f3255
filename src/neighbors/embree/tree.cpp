#include "neighbors/embree/tree.hpp"

#include <tbb/parallel_for.h>

#include <atomic>

namespace grainray::embree {
namespace {

#if GRAINRAY_EMBREE >= 4
using RayContext = RTCRayQueryContext;
void cast(RTCScene scene, RTCRay& ray, RayContext& context) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.context = &context;
    rtcOccluded1(scene, &ray, &arguments);
}
void start(RayContext& context) { rtcInitRayQueryContext(&context); }
#else
using RayContext = RTCIntersectContext;
void cast(RTCScene scene, RTCRay& ray, RayContext& context) { rtcOccluded1(scene, &context, &ray); }
void start(RayContext& context) { rtcInitIntersectContext(&context); }
#endif

struct Question {
    RayContext context;  // first, so that the callback finds the rest behind it
    void (*call)(const void*, std::uint32_t);
    const void* visit;
};

/// Reports no hit, so the ray goes on to the next box.
void on_ray(const RTCOccludedFunctionNArguments* a) {
    const auto* question = reinterpret_cast<const Question*>(a->context);
    question->call(question->visit, a->primID);
}

bool on_point(RTCPointQueryFunctionArguments* a) {
    const auto* question = static_cast<const Question*>(a->userPtr);
    question->call(question->visit, a->primID);
    return false;
}

bool count_bytes(void* total, ssize_t bytes, bool) {
    std::atomic_ref<std::int64_t>(*static_cast<std::int64_t*>(total)).fetch_add(bytes, std::memory_order_relaxed);
    return true;
}

}  // namespace

void Asker::ask_by_ray(const Vec3f& c, Call found, const void* visit) const {
    Question question;
    start(question.context);
    question.call = found;
    question.visit = visit;
    RTCRay ray{};
    ray.org_x = c.x, ray.org_y = c.y, ray.org_z = c.z;
    ray.dir_x = ray.dir_y = ray.dir_z = 0.57735f;  // no zero among them: 0 * infinity on the face of a box is no number
    ray.tfar = 1e-16f;
    ray.mask = ~0u;
    cast(scene, ray, question.context);
}

void Asker::ask_by_distance(const Vec3f& c, float radius, Call found, const void* visit) const {
    Question question;
    question.call = found;
    question.visit = visit;
    RTCPointQuery query{c.x, c.y, c.z, 0, radius};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, on_point, &question);
}

Tree::Tree() {
    // Embree builds with denormal numbers off. oneTBB hands each task the settings that this thread had when it first used
    // oneTBB, so that must not be inside Embree, or later sums anywhere in the program would round differently.
    tbb::parallel_for(0, 1, [](int) {});
    device_ = rtcNewDevice(nullptr);
    if (!device_) throw SimulationError("Embree could not start; search by cells instead");
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
}

Tree::~Tree() {
    if (scene_) rtcReleaseScene(scene_);
    if (device_) rtcReleaseDevice(device_);
}

void Tree::bounds(const RTCBoundsFunctionArguments* a) {
    const auto& tree = *static_cast<const Tree*>(a->geometryUserPtr);
    const neighbors::Sphere s = tree.points_[a->primID];
    const auto box = tree.frame_.box({s.x, s.y, s.z}, s.reach + tree.extra_);
    *a->bounds_o = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
}

void Tree::build(View<const neighbors::Sphere> points, float extra, const neighbors::rays::Frame& frame) {
    points_ = points;
    extra_ = extra;
    frame_ = frame;
    if (scene_) rtcReleaseScene(scene_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    // Low: built three times faster than medium for searches as fast; and no spatial splits, so that each box is met once.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(points.size));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryOccludedFunction(geometry, on_ray);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    check();
}

void Tree::check() const {
    const RTCError error = rtcGetDeviceError(device_);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw SimulationError("out of memory in the search by rays; search by cells, or use fewer particles");
    throw SimulationError("Embree failed in the search by rays (error " + std::to_string(error) + "); search by cells instead");
}

std::size_t Tree::memory_bytes() const {
    const std::int64_t bytes = std::atomic_ref<std::int64_t>(bytes_).load();
    return bytes > 0 ? static_cast<std::size_t>(bytes) : 0;
}

std::string version() {
    const std::string digits = RTC_VERSION_STRING;
    return "Embree " + digits;
}

}  // namespace grainray::embree
