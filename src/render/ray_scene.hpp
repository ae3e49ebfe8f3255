// Spheres and triangles that rays can be asked about. Embree, version 3 or 4, stays behind this header.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "render/skin.hpp"
#include "render/subject.hpp"
#include "render/view.hpp"

namespace grainray::picture {

class RayScene {
public:
    /// Uses spheres and skins where they are: they must outlive this. Throws SimulationError (out of memory).
    RayScene(const std::vector<Sphere>&, const std::vector<const Skin*>&);
    ~RayScene();

    struct Hit {
        float distance;
        std::uint32_t part;       ///< 0: the spheres; k + 1: skin k
        std::uint32_t primitive;  ///< the sphere or the triangle
        float u, v;               ///< where on a triangle
    };
    /// The first thing farther than `from` along the ray.
    std::optional<Hit> first(const Ray&, float from = 0) const;
    bool empty() const { return empty_; }
    bool blocked(const Ray&) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    bool empty_;
};

}  // namespace grainray::picture
