// Spheres that rays can be asked about. Embree, version 3 or 4, stays behind this header.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "render/subject.hpp"
#include "render/view.hpp"

namespace grainray::picture {

class RayScene {
public:
    /// Copies the spheres. Throws SimulationError (out of memory).
    explicit RayScene(const std::vector<Sphere>&);
    ~RayScene();

    struct Hit {
        float distance;
        std::uint32_t sphere;
    };
    std::optional<Hit> first(const Ray&) const;
    bool blocked(const Ray&) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainray::picture
