// Particles that come and go: what the stages of exchange.cpp are told, and what they tell.
#pragma once

#include "state.hpp"

namespace grainray {

/// A sphere that is there.
struct Resident {
    Vec3l position;  ///< fine units
    std::int32_t radius;
};

/// A region out of which particles are taken. Relative to the world's origin.
struct Exit {
    enum class Kind : std::uint32_t {
        box,         ///< the centre is in [a, b]
        half_space,  ///< the centre is beyond the plane through a, on the side of its normal b
        outside,     ///< the centre is not in [a, b]
        left,        ///< the whole sphere is beyond the sides [a, b] of an open terrain or below a.z
    };
    Kind kind = Kind::box;
    Vec3d a, b;

    GR_HD bool takes(const Vec3d& x, double radius) const {
        switch (kind) {
            case Kind::box: return inside(x);
            case Kind::half_space: return dot(b, x - a) > 0;
            case Kind::outside: return !inside(x);
            default:
                return x.x + radius < a.x || x.x - radius > b.x || x.y + radius < a.y || x.y - radius > b.y || x.z + radius < a.z;
        }
    }
    GR_HD bool inside(const Vec3d& x) const { return x.x >= a.x && x.y >= a.y && x.z >= a.z && x.x <= b.x && x.y <= b.y && x.z <= b.z; }
};

/// A particle that was taken out.
struct Departure {
    std::uint32_t id, exit;  ///< exit: number of the region, the first that took it
    Vec3l position;          ///< fine units
    Vec3f velocity;
    float mass;
    std::int32_t radius;     ///< units
};

}  // namespace grainray
