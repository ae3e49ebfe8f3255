// Host copies of what an observer needs, and the contacts in them.
#pragma once

#include <functional>

#include "contacts/laws.hpp"
#include "simulation_impl.hpp"

namespace grainray {

/// One touching pair or particle-plane contact; wall: j is the plane.
struct TouchingContact {
    std::uint32_t i, j;
    bool wall;
    double overlap;  ///< m
    Vec3f force;     ///< on i, N
    Vec3f history;   ///< on i, N
};

struct Snapshot {
    Snapshot(const State&, ContactLaw);
    std::vector<Near> near;
    std::vector<Far> far;
    std::vector<Body> body;
    std::vector<Vec3f> remainder;
    std::vector<std::uint32_t> id;
    std::vector<std::uint64_t> grain_offsets, wall_offsets;
    std::vector<std::uint32_t> grain_partners, wall_partners;
    std::vector<Vec3f> grain_history, wall_history;
    std::vector<PlaneNow> planes;
    std::vector<PairParameters> grain_parameters, wall_parameters;
    PositionScale scale;
    Vec3l period, period_lower;
    std::uint32_t block, materials;
    ContactLaw law;

    std::size_t size() const { return near.size(); }
    /// Fixed-point position, inside the periodic box.
    Vec3l position(std::size_t i) const;
    double radius(std::size_t i) const { return near[i].radius * scale.unit; }
    /// Every touching contact once, in storage order.
    void for_each_contact(const std::function<void(const TouchingContact&)>&) const;
};

}  // namespace grainray
