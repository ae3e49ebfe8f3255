#include "validation/cases.hpp"

#include <algorithm>

namespace grainray {
namespace validation {

void Report::add(const std::string& quantity, double expected, double got, double tolerance, bool relative, const std::string& source) {
    const double allowed = relative ? tolerance * std::fabs(expected) : tolerance;
    const bool pass = std::fabs(got - expected) <= allowed;  // false for NaN
    results.push_back({name_, quantity, source, expected, got, tolerance, relative, pass, true});
}
void Report::relative(const std::string& quantity, double expected, double got, double tolerance, const std::string& source) {
    add(quantity, expected, got, tolerance, true, source);
}
void Report::absolute(const std::string& quantity, double expected, double got, double tolerance, const std::string& source) {
    add(quantity, expected, got, tolerance, false, source);
}
void Report::shown(const std::string& quantity, double expected, double got, const std::string& source) {
    results.push_back({name_, quantity, source, expected, got, 0, false, true, false});
}

Trial::Trial(double dt, const Law& grain, const Law& wall, const Vec3d& gravity, double alpha) {
    scene.dt = dt;
    scene.gravity = gravity;
    scene.contact.mass_damping = alpha;
    scene.materials = {{"grain", 2000, grain.kn, grain.kt, grain.mu, grain.bn, grain.bt},
                       {"wall", 2000, wall.kn, wall.kt, wall.mu, wall.bn, wall.bt}};
    yardstick.dt = dt;
    yardstick.alpha = alpha;
    yardstick.gravity = gravity;
    yardstick.pair = grain;
    yardstick.wall = wall;
}

void Trial::sphere(const Vec3d& x, const Vec3d& v, const Vec3d& w, double r, double density) {
    std::uint32_t material = 0;  // grain; another density is a copy of it
    if (density != 2000) {
        material = static_cast<std::uint32_t>(scene.materials.size());
        scene.materials.push_back(scene.materials[0]);
        scene.materials.back().name = "grain" + std::to_string(material);
        scene.materials.back().density = density;
    }
    initial.positions.push_back(x);
    initial.velocities.push_back(v);
    initial.angular_velocities.push_back(w);
    initial.radii.push_back(r);
    initial.materials.push_back(material);
    yardstick.spheres.push_back({x, v, w, r, 4.0 / 3.0 * pi * r * r * r * density});
}

void Trial::plane(const Vec3d& point, const Vec3d& normal, const Motion& motion) {
    scene.planes.push_back({"plane" + std::to_string(scene.planes.size()), "wall", point, normal, motion});
    yardstick.walls.push_back({point, normal, motion.velocity, motion.rotation_axis, motion.rotation_point, motion.rotation_rate});
}

void compare(Report& report, const std::string& when, const Simulation& simulation, const Yardstick& yardstick, double tolerance_x,
             double tolerance_v) {
    const Frame frame = simulation.frame();
    double x = 0, v = 0, fastest = 0;
    for (std::size_t i = 0; i < frame.size(); ++i) {
        const Sphere& s = yardstick.spheres[i];
        x = std::max(x, length(frame.position[i] - s.x) / s.r);
        v = std::max({v, length(convert<double>(frame.velocity[i]) - s.v), length(convert<double>(frame.angular_velocity[i]) - s.w) * s.r});
        fastest = std::max({fastest, length(s.v), length(s.w) * s.r});
    }
    const std::string source = "scheme in double";
    report.absolute(when + ": worst |dx| / r", 0, x, tolerance_x, source);
    report.absolute(when + ": worst |dv| / fastest", 0, fastest > 0 ? v / fastest : v, tolerance_v, source);
}

}  // namespace validation

namespace {

/// One instance a case, so that the table of cases is made of plain function pointers.
template <void (*body)(validation::Report&)>
std::vector<ValidationResult> run(const ValidationCase& c, const SimulationOptions& options) {
    validation::Report report(c.name, options);
    body(report);
    return std::move(report.results);
}

}  // namespace

const std::vector<ValidationCase>& validation_cases() {
    using namespace validation;
    static const std::vector<ValidationCase> cases{
        {"free fall", true, run<free_fall>},
        {"mass damping", true, run<mass_damping>},
        {"bounce on a plane", true, run<bounce_on_plane>},
        {"bounce of two spheres", true, run<bounce_of_pair>},
        {"100 bounces undamped", true, run<hundred_bounces>},
        {"oblique collision", true, run<oblique_collision>},
        {"unequal pair 1:10", true, run<unequal_pair>},
        {"heavy sphere as wall", true, run<heavy_sphere_as_wall>},
        {"two materials", true, run<materials>},
        {"sliding to rolling", true, run<sliding_to_rolling>},
        {"inclines", true, run<inclines>},
        {"stack of 10", true, run<stack>},
        {"piston", true, run<piston>},
        {"turntable", true, run<turntable>},
        {"paddle", true, run<paddle>},
        {"heap in a corner", true, run<heap>},
        {"periodic crossing", true, run<periodic_crossing>},
        {"shifted world", true, run<shifted_world>},
        {"column A, first 2 s", true, run<column_a_start>},
        {"column B, first 2 s", true, run<column_b_start>},
        {"column A", false, run<column_a>},
        {"column B", false, run<column_b>},
    };
    return cases;
}

std::vector<ValidationResult> validate(const std::vector<std::string>& only, bool quick, const SimulationOptions& options) {
    const auto& cases = validation_cases();
    for (const std::string& name : only)
        if (std::none_of(cases.begin(), cases.end(), [&](const auto& c) { return c.name == name; })) {
            std::string known;
            for (const auto& c : cases) known += (known.empty() ? "'" : ", '") + c.name + "'";
            throw InputError("validation case '" + name + "' is not known; known are: " + known);
        }
    std::vector<ValidationResult> results;
    for (const ValidationCase& c : cases) {
        const bool named = std::find(only.begin(), only.end(), c.name) != only.end();
        if (only.empty() ? quick && !c.quick : !named) continue;
        for (auto& r : c.run(c, options)) results.push_back(std::move(r));
    }
    return results;
}

}  // namespace grainray
