// One Embree scene of boxes, one a point, and two ways of asking which boxes are near a place.
#pragma once

#include <cstdint>
#include <string>

#include "grainray/device.hpp"
#include "neighbors/rays/boxes.hpp"

#if GRAINRAY_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace grainray::embree {

/// For kernels: asks, from any thread. Both ways may call visit(point) for boxes that are not quite there.
struct Asker {
    RTCScene scene;
    bool by_ray;  ///< a ray of length 1e-16 instead of a point query

    /// visit(p) for every box that comes within `radius` of c (or, by ray, holds c), all in the tracer's frame.
    template <class Visit>
    void near(const Vec3f& c, float radius, const Visit& visit) const {
        if (by_ray) ask_by_ray(c, &call<Visit>, &visit);
        else ask_by_distance(c, radius, &call<Visit>, &visit);
    }

private:
    using Call = void (*)(const void* visit, std::uint32_t point);
    template <class Visit>
    static void call(const void* visit, std::uint32_t point) { (*static_cast<const Visit*>(visit))(point); }
    void ask_by_ray(const Vec3f&, Call, const void* visit) const;
    void ask_by_distance(const Vec3f&, float radius, Call, const void* visit) const;
};

class Tree {
public:
    Tree();
    ~Tree();
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    /// Boxes of half-width reach + extra around the points; they are read until the next build.
    void build(View<const neighbors::Sphere> points, float extra, const neighbors::rays::Frame&);
    /// Throws what Embree could not do since the last call.
    void check() const;
    RTCScene scene() const { return scene_; }
    std::size_t memory_bytes() const;

private:
    static void bounds(const RTCBoundsFunctionArguments*);

    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    View<const neighbors::Sphere> points_;
    float extra_ = 0;
    neighbors::rays::Frame frame_;
    mutable std::int64_t bytes_ = 0;
};

/// "Embree 3.13.5".
std::string version();

}  // namespace grainray::embree
