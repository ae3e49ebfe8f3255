// One particle on the facets of one surface: which it touches, on which side, how much of the contact is each one's, and
// what the law makes of it. Shared by the stage and by observers.
//
// Facet i takes the share w_i = s_i (r + d_i) / (r + d) of a contact with its plane, where s_i is its share of the disc in
// which the plane cuts the sphere, d_i the plane's distance and d that of the one plane that would press as hard. On a plane
// of many triangles w_i = s_i, which add up to 1. At edges the elastic forces are then areas times one pressure, so minus
// the gradient of the volume cut off times that pressure; a sphere gains no energy where it follows from the volume alone.
// Nearly so: d is the distance of the plane whose disc is as large as the vector sum of the discs, which is that gradient.
//
// Every facet has a tangential history of its own, as if it were the whole contact. One that begins to touch takes over
// the mean of those that touched in the step before, weighted by how nearly they face the same way: on a plane all
// histories are one, and a seam is not felt; in a corner of 90 degrees nothing passes from floor to wall.
#pragma once

#include "boundary/facets.hpp"
#include "exec/bits.hpp"
#include "grainray/particles.hpp"

namespace grainray {

/// A particle as a surface sees it, relative to the world's origin.
struct FacetParticle {
    Vec3d position;  ///< m
    double radius;   ///< m
    Body body;
};

/// What the facets of one surface do to a particle, N and N m.
struct FacetForce {
    Vec3d force, torque;
    double overlap = 0;     ///< of the facet with most of its disc, or the mean over the disc areas, whichever is larger, m
    bool touching = false, crossed = false;
};

/// The entries of one surface in one row.
struct FacetEntries {
    const std::uint32_t* facets;
    FacetState* states;
    float* shares;
    std::uint32_t size;
};

/// The entries of a row that matter in a step, one after the other: the first 32 whose bits are set, and all after those.
struct Picked {
    std::uint32_t bits = 0, next = 32;
    GR_HD bool left(std::uint32_t size) const { return bits != 0 || next < size; }
    GR_HD std::uint32_t take() {
        if (bits == 0) return next++;
        const std::uint32_t e = lowest_bit(bits);
        bits &= bits - 1;
        return e;
    }
};

template <class Law>
struct FacetContact {
    Law law;
    const FacetShapes& shapes;
    const Surface& surface;
    const SurfaceNow& now;
    const PairParameters& parameters;
    FacetParticle particle;
    FacetEntries entries;
    double dt;

    /// In the frame of the surface; the motion is that of the step before, relative to the surface.
    struct Seen {
        Vec3d x, step;
        double side = 0;
        double distance = 0;  ///< mean of the planes' distances over the areas of their discs
        double pressing = 0;  ///< distance of the one plane that would press as hard
    };

    GR_HD FacetForce operator()() const {
        Seen v;
        v.x = now.into(particle.position);
        const Vec3d arm = particle.position - now.centre;
        const Vec3d moved = convert<double>(particle.body.velocity) - convert<double>(now.velocity) - cross(convert<double>(now.spin), arm);
        v.step = now.turned_back(moved) * dt;
        FacetForce out;
        const Picked picked = pick(v);
        out.touching = look(v, picked, out);
        if (out.touching) inherit(v, picked);
        out.overlap = particle.radius - v.distance;
        apply(v, picked, out);
        return out;
    }

private:
    static constexpr float touched_by_rim = 2;

    /// Could an entry touch, have been gone through since the step before, or does it remember anything?
    GR_HD bool matters(const Seen& v, std::uint32_t e) const {
        return entries.states[e].side != 0 || !shapes.apart(surface, entries.facets[e], v.x, particle.radius + length(v.step));
    }
    /// Most candidates do not matter. They are left out first, so that the threads of a warp evaluate those that do at once.
    GR_HD Picked pick(const Seen& v) const {
        Picked picked;
        for (std::uint32_t e = 0; e < entries.size && e < picked.next; ++e) picked.bits |= std::uint32_t{matters(v, e)} << e;
        return picked;
    }

    /// Shares, mean distance, side; and whether the particle went through a facet since the step before.
    GR_HD bool look(Seen& v, const Picked& picked, FacetForce& out) const {
        double area = 0, height = 0, before = 0, side = 0;
        bool rim = false;
        double shares = 0;
        Vec3d push;
        for (Picked p = picked; p.left(entries.size);) {
            const std::uint32_t e = p.take();
            if (e >= 32 && !matters(v, e)) {
                entries.shares[e] = 0;
                continue;
            }
            Triangle t = shapes.facet(surface, entries.facets[e]);
            const Section s = shapes.section_of(surface, entries.facets[e], t, v.x, particle.radius);
            entries.shares[e] = s.rim ? touched_by_rim : s.share;
            const double step = dot(t.normal, v.step), was = entries.states[e].side;
            if (side == 0) side = was;
            rim = rim || s.rim;
            if (s.share > 0 && !s.rim) {
                const double part = s.share * (particle.radius - s.distance) * (particle.radius + s.distance);
                area += part;
                push += t.normal * part;
                shares += s.share;
                height += part * s.distance;
                before += part * (s.distance - step);
            }
            if (!(s.share > 0)) out.crossed = out.crossed || went_through(t, v, s.distance, step, was);
        }
        if (surface.terrain) side = 1;
        v.side = side != 0 ? side : before >= 0 ? 1 : -1;
        v.distance = area > 0 ? v.side * height / area : particle.radius;
        v.pressing = pressing(v.distance, length(push), shares);
        return area > 0 || rim;
    }

    /// Discs that one edge cuts have shares that add up to 1 at most. Where they add up to 2, as between two walls, none knows of
    /// the other, and both press as planes do. `push` is an area over pi.
    GR_HD double pressing(double mean, double push, double shares) const {
        const double square = particle.radius * particle.radius - push, distance = square > 0 ? sqrt(square) : 0, more = distance - fabs(mean);
        const double convex = shares < 1 ? 1 : shares < 2 ? 2 - shares : 0;
        return more > 0 ? mean + more * convex : mean;
    }

    /// The centre left the facet's other side, having touched it, or came from one side and is beyond the other.
    GR_HD bool went_through(const Triangle& t, const Seen& v, double distance, double step, double was) const {
        const double old = was != 0 ? was : distance - step;
        if (!(distance * old < 0) || (was == 0 && step == 0)) return false;
        const double back = was != 0 || step == 0 ? 0 : distance / step;
        const Vec3d x = v.x - v.step * back;
        for (int edge = 0; edge < 3; ++edge)
            if (!(edge_view(t, edge, x).height >= 0)) return false;
        return true;
    }

    GR_HD void inherit(const Seen& v, const Picked& picked) const {
        for (Picked p = picked; p.left(entries.size);) {
            const std::uint32_t e = p.take();
            if (!(entries.shares[e] > 0) || entries.states[e].side != 0) continue;
            const Vec3d n = shapes.facet(surface, entries.facets[e]).normal;
            double sum = 0, most = 0;
            Vec3d mean;
            for (Picked other = picked; other.left(entries.size);) {
                const std::uint32_t o = other.take();
                if (entries.states[o].side == 0) continue;
                const double cosine = v.side * entries.states[o].side * dot(n, shapes.facet(surface, entries.facets[o]).normal);
                const double held = cosine > 0 ? cosine : 0, weight = held * held * held * held;
                sum += weight;
                most = held > most ? held : most;
                mean += convert<double>(entries.states[o].history) * weight;
            }
            const double gain = 2 * most < 1 ? 2 * most : 1;  // full below 60 degrees
            entries.states[e].history = sum > 0 ? convert<float>(mean * (gain / sum)) : Vec3f{};
        }
    }

    GR_HD void apply(const Seen& v, const Picked& picked, FacetForce& out) const {
        for (Picked p = picked; p.left(entries.size);) {
            const std::uint32_t e = p.take();
            FacetState& state = entries.states[e];
            if (!(entries.shares[e] > 0)) {
                if (state.side != 0) state = FacetState{};
                continue;
            }
            Triangle t = shapes.facet(surface, entries.facets[e]);
            const bool rim = entries.shares[e] == touched_by_rim;
            const double height = dot(t.normal, v.x - t.a);
            Vec3d n = t.normal * v.side;
            double distance = v.side * height, weight = entries.shares[e] * ((particle.radius + distance) / (particle.radius + v.pressing));
            if (rim) {
                const Vec3d apart = v.x - shapes.section_of(surface, entries.facets[e], t, v.x, particle.radius).nearest;
                distance = length(apart);
                n = apart * (1 / (distance > 0 ? distance : 1));
                weight = 1;
            }
            state.side = static_cast<float>(rim ? (height < 0 ? -1 : 1) : v.side);
            touch(now.turned(n), particle.radius - distance, weight, state.history, out);
            if (entries.shares[e] > 0.5f && particle.radius - distance > out.overlap) out.overlap = particle.radius - distance;
        }
    }

    GR_HD void touch(const Vec3d& normal, double depth, double weight, Vec3f& history, FacetForce& out) const {
        const Body& b = particle.body;
        const Vec3f n = convert<float>(normal);
        const float overlap = static_cast<float>(depth), arm = fmaxf(static_cast<float>(particle.radius) - 0.5f * overlap, 0.0f);
        const Vec3f from_centre = convert<float>(particle.position - now.centre) - n * arm;
        const Vec3f velocity = b.velocity - cross(b.spin * arm, n) - (now.velocity + cross(now.spin, from_centre));
        const Vec3f force = law(Contact{n, overlap, velocity, b.mass}, parameters, history);
        out.force += convert<double>(force) * weight;
        out.torque += convert<double>(cross(n, force) * -arm) * weight;
    }
};

}  // namespace grainray
