// What the cases share: a report, and a trial that holds the same spheres for the engine and for the yardstick.
#pragma once

#include "grainray/validation.hpp"
#include "validation/yardstick.hpp"

namespace grainray::validation {

inline constexpr double pi = 3.14159265358979323846;

class Report {
public:
    Report(std::string name, const SimulationOptions& o) : options(o), name_(std::move(name)) {}
    /// Passes within `tolerance` times |expected|.
    void relative(const std::string& quantity, double expected, double got, double tolerance, const std::string& source);
    /// Passes within `tolerance`.
    void absolute(const std::string& quantity, double expected, double got, double tolerance, const std::string& source);
    /// For comparison only.
    void shown(const std::string& quantity, double expected, double got, const std::string& source);

    SimulationOptions options;
    std::vector<ValidationResult> results;

private:
    void add(const std::string& quantity, double expected, double got, double tolerance, bool relative, const std::string& source);
    std::string name_;
};

/// One grain material, one wall material (mixing "wall"), and the yardstick beside them.
class Trial {
public:
    Trial(double dt, const Law& grain, const Law& wall, const Vec3d& gravity = {}, double alpha = 0);
    void sphere(const Vec3d& x, const Vec3d& v = {}, const Vec3d& w = {}, double r = 0.1, double density = 2000);
    void plane(const Vec3d& point, const Vec3d& normal, const Motion& motion = {});
    Simulation start(const Report& report) const { return Simulation(scene, initial, report.options); }
    double mass(std::size_t i) const { return yardstick.spheres[i].m; }

    Scene scene;
    InitialState initial;
    Yardstick yardstick;
};

/// Largest differences of positions (in radii), velocities and surface speeds (in the largest of those speeds) from the yardstick.
void compare(Report&, const std::string& when, const Simulation&, const Yardstick&, double tolerance_x, double tolerance_v);

// free.cpp
void free_fall(Report&);
void mass_damping(Report&);
void periodic_crossing(Report&);
void shifted_world(Report&);
void heap(Report&);
// collisions.cpp
void bounce_on_plane(Report&);
void bounce_of_pair(Report&);
void hundred_bounces(Report&);
void oblique_collision(Report&);
void unequal_pair(Report&);
void heavy_sphere_as_wall(Report&);
void materials(Report&);
// rolling.cpp
void sliding_to_rolling(Report&);
void inclines(Report&);
void stack(Report&);
void piston(Report&);
void turntable(Report&);
void paddle(Report&);
// column.cpp
void column_a_start(Report&);
void column_b_start(Report&);
void column_a(Report&);
void column_b(Report&);

}  // namespace grainray::validation
