// The equations of DESIGN once more, in double precision and as plainly as possible: symplectic Euler, the linear law, all
// pairs, a handful of spheres. Shares no code with the engine beyond Vec3, so that both must be wrong alike to agree.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "grainray/core.hpp"

namespace grainray::validation {

struct Law {
    double kn = 1e5, kt = 1e5, mu = 0, bn = 0, bt = 0;  ///< stiffness N/m, friction, damping as a fraction beta
};

struct Sphere {
    Vec3d x, v, w;  ///< centre, velocity, spin
    double r = 0.1, m = 1;
};

/// A half-space that may slide and turn about an axis.
struct Wall {
    Vec3d point, normal{0, 0, 1}, velocity;
    Vec3d axis, centre;  ///< unit axis of rotation and a point on it
    double rate = 0;     ///< rad/s
};

class Yardstick {
public:
    double dt = 1e-3, alpha = 0, time = 0;
    Vec3d gravity;
    Law pair, wall;
    std::vector<Sphere> spheres;
    std::vector<Wall> walls;

    void step();
    void run(int steps) {
        for (int k = 0; k < steps; ++k) step();
    }
    int contacts() const { return static_cast<int>(elastic_.size()); }

private:
    using Key = std::pair<int, int>;  ///< sphere and sphere, or sphere and -1 - wall
    struct Touch {
        Vec3d n;           ///< to i
        double u;          ///< overlap
        Vec3d v;           ///< of i against the other, at the contact point
        double mean_mass;
    };
    Vec3d force(const Law&, const Touch&, const Key&);
    void touch_pair(int i, int j);
    void touch_wall(int i, int q);
    void push(int i, const Vec3d& f, const Vec3d& torque);

    std::map<Key, Vec3d> elastic_;  ///< tangential elastic force on the first
    std::vector<Vec3d> force_, torque_;
};

}  // namespace grainray::validation
