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

/// One particle on one mesh or the terrain, all its facets together.
struct FacetTouch {
    std::uint32_t i, surface;   ///< surface: meshes in the order of the scene, then the terrain
    double overlap;             ///< the largest, m
    Vec3f force;                ///< on i, N
    Vec3d on_surface, torque;   ///< force on the surface, N, and torque on it about its centre of rotation, N m
};

/// Host copies of the surfaces and rows.
struct FacetSnapshot {
    explicit FacetSnapshot(const Facets&);
    std::vector<Surface> surfaces;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> cell_offsets, cell_triangles;
    std::vector<double> heights;
    std::vector<SurfaceNow> now;
    std::vector<PairParameters> parameters;
    std::vector<std::uint32_t> particles;
    std::vector<std::uint64_t> offsets;
    std::vector<std::uint32_t> facets;
    std::vector<FacetState> states;
    FacetShapes shapes() const;
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
    FacetSnapshot facets;
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
    /// Every touching contact once, without its force: visit(i, j, wall, history).
    void for_each_history(const std::function<void(std::uint32_t, std::uint32_t, bool, const Vec3f&)>&) const;
    /// Every particle on every mesh or terrain it touches, in storage order.
    void for_each_facet_contact(const std::function<void(const FacetTouch&)>&) const;
    /// What the next step needs to know of the last one.
    void for_each_facet_memory(const std::function<void(std::uint32_t i, std::uint32_t facet, const FacetState&)>&) const;
};

/// Places of the particles by ascending id.
std::vector<std::uint32_t> places_by_id(const std::vector<std::uint32_t>& id);

/// Into a checkpoint, and out of it as rows of an old list.
void add_facets(const Snapshot&, Checkpoint&);
void restore_facets(const Checkpoint&, FacetList&);

}  // namespace grainray
