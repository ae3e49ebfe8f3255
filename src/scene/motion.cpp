// [... .motion] -> Motion, and how far a motion has got at a time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/csv.hpp"
#include "scene/read.hpp"

namespace grainray {
namespace scene {
namespace {

void read_path(const Node& motion, const Scene& s, Motion& m) {
    const std::filesystem::path file = m.path_file.is_absolute() ? m.path_file : s.file.parent_path() / m.path_file;
    const CsvTable table = read_csv_table(file, motion.child("path"), {"t", "x", "y", "z"});
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
        const auto& v = table.rows[row];
        if (row > 0 && !(v[0] > m.path.back().time))
            throw InputError(fmt::format("{}:{}: column 't': {} must be greater than in the row before ({})", file.string(), table.lines[row], v[0],
                                         m.path.back().time));
        m.path.push_back({v[0], {v[1], v[2], v[3]}});
    }
    if (m.path.empty()) throw InputError(fmt::format("{}: holds no row; give at least one time and place", file.string()));
}

}  // namespace

Motion read_motion(const Node& table, const Scene& s) {
    Motion m;
    const Node motion = table.child("motion"), rotation = motion.child("rotation"), oscillation = motion.child("oscillation");
    PathRow path;
    read_table(motion, schema().motion, m, {"rotation", "oscillation", "path"});
    read_fields(motion, schema().motion_path, path);
    if (!(m.stop > m.start)) fail_key(motion, "stop", fmt::format("must be greater than start ({} s)", m.start));
    if (motion.has("rotation")) {
        read_table(rotation, schema().rotation, m);
        m.rotation_axis = unit_vector(rotation, "axis", m.rotation_axis);
    }
    if (motion.has("oscillation")) read_table(oscillation, schema().oscillation, m);
    if (path.path) m.path_file = *path.path, read_path(motion, s, m);
    return m;
}

namespace {

/// Shift and velocity after t seconds of motion along the table.
std::pair<Vec3d, Vec3d> along_path(const std::vector<Waypoint>& path, double t) {
    if (path.empty()) return {};
    if (t < path.front().time) return {path.front().shift, {}};
    if (t >= path.back().time) return {path.back().shift, {}};
    const auto next = std::upper_bound(path.begin(), path.end(), t, [](double time, const Waypoint& w) { return time < w.time; });
    const Waypoint &a = *(next - 1), &b = *next;
    const Vec3d velocity = (b.shift - a.shift) * (1 / (b.time - a.time));
    return {a.shift + velocity * (t - a.time), velocity};
}

}  // namespace
}  // namespace scene

/// Rodrigues.
Vec3d turned(const Vec3d& v, const Vec3d& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

MotionState motion_at(const Motion& m, double time) {
    const bool moving = m.moves() && time >= m.start && time < m.stop;
    const double t = std::max(0.0, std::min(time, m.stop) - m.start);  // how long it has moved
    const double omega = 2 * std::numbers::pi * m.oscillation_frequency, phase = omega * t + m.oscillation_phase;
    const auto [place, speed] = scene::along_path(m.path, t);
    MotionState state;
    state.shift = m.velocity * t + m.oscillation_amplitude * (std::sin(phase) - std::sin(m.oscillation_phase)) + place;
    if (m.rotation_rate != 0 && t > 0) state.angle = m.rotation_rate * t;
    if (moving) {
        state.velocity = m.velocity + m.oscillation_amplitude * (omega * std::cos(phase)) + speed;
        state.angular_velocity = m.rotation_axis * m.rotation_rate;
    }
    return state;
}

double greatest_speed(const Motion& m) {
    double along = 0;
    for (std::size_t k = 1; k < m.path.size(); ++k)
        along = std::max(along, length(m.path[k].shift - m.path[k - 1].shift) / (m.path[k].time - m.path[k - 1].time));
    return length(m.velocity) + length(m.oscillation_amplitude) * 2 * std::numbers::pi * std::fabs(m.oscillation_frequency) + along;
}

}  // namespace grainray
