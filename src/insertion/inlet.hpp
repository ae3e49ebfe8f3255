// Where a stream's particles may appear, and how long they take to leave.
#pragma once

#include <memory>
#include <optional>

#include "grainray/scene.hpp"
#include "scene/random.hpp"

namespace grainray {

/// A region at one time. A place in it is a function of random numbers.
class InletRegion {
public:
    virtual ~InletRegion() = default;
    /// Centre of a sphere that lies wholly in the region, from the numbers 4 k ... 4 k + 3; none where those lead to none.
    virtual std::optional<Vec3d> place(const scene::Random&, std::uint64_t k, double radius) const = 0;

    Box bounds{};       ///< m
    double volume = 0;  ///< m3
    std::array<bool, 3> wraps{};  ///< it goes on at the other end of the periodic domain
};

class Inlet {
public:
    /// Reads the surface. Throws InputError: unreadable, no facet, outside the domain, no room for the largest particle.
    Inlet(const Scene&, const ParticleStream&);
    std::unique_ptr<InletRegion> at(double time) const;
    /// Time in which a particle crosses it under its mean velocity and gravity, s.
    double crossing_time() const;

private:
    void require_room() const;

    const Scene& scene_;
    const ParticleStream& stream_;
    TriangleMesh surface_;  ///< facets in their mesh's own frame
};

/// "scene.toml: key 'streams.NAME.field'", for errors that only running finds.
std::string place_of(const Scene&, const ParticleStream&, const std::string& field = "");
/// Volume of a sphere, m3.
double sphere_volume(double radius);
/// Mass as the particle will have it, kg.
double particle_mass(double radius, double density);

}  // namespace grainray
