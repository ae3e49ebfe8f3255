#include "grainray/particles.hpp"

namespace grainray {

PositionScale PositionScale::for_radius(double largest_radius, const Vec3d& origin) {
    return {std::ldexp(1.0, std::ilogb(largest_radius) - 26), origin};
}

Vec3l PositionScale::fixed(const Vec3d& world) const {
    const Vec3d p = (world - origin) * (1.0 / fine());
    for (int a = 0; a < 3; ++a)
        if (!(std::fabs(p[a]) < 4e18))
            throw InputError("position " + std::to_string(world[a]) + " m is outside the world, which reaches " + std::to_string(4e18 * fine()) +
                             " m from the middle of the particles (" + std::to_string(origin[a]) + " m) at this particle size; look for a particle placed too far away");
    return {std::llrint(p.x), std::llrint(p.y), std::llrint(p.z)};
}

}  // namespace grainray
