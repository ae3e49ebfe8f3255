#include "restart.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace grainray::cli {
namespace {

namespace fs = std::filesystem;

/// Keys of a scene with their values as text: units and defaults are gone, so that equal texts mean equal values.
class Facts {
public:
    /// `kept`: the checkpoint's value is what counts, another one in the scene would do nothing.
    Facts(const Scene& s, bool kept) {
        kept ? add_kept(s) : add_acting(s);
    }
    const std::map<std::string, std::string>& all() const { return all_; }

private:
    void add(const std::string& key, const std::string& value) { all_[key] = value; }
    void add(const std::string& key, double value) { add(key, fmt::format("{}", value)); }
    void add(const std::string& key, const Vec3d& v) { add(key, fmt::format("[{}, {}, {}]", v.x, v.y, v.z)); }
    void add(const std::string& key, const std::optional<double>& value) {
        if (value) add(key, *value);
    }
    void add(const std::string& key, const std::vector<double>& values) { add(key, fmt::format("[{}]", fmt::join(values, ", "))); }
    void add(const std::string& key, const std::vector<Vec3d>& values) {
        std::string text;
        for (const Vec3d& v : values) text += fmt::format("[{}, {}, {}] ", v.x, v.y, v.z);
        add(key, text);
    }

    void add_kept(const Scene& s) {
        add("simulation.method", s.method);
        add("simulation.seed", fmt::format("{}", s.seed));
        add("domain.periodic", fmt::format("{}", fmt::join(s.domain.periodic, ", ")));
        const auto& p = s.domain.periodic;
        if (p[0] || p[1] || p[2]) add_box("domain", s.domain.box);
        for (const Material& m : s.materials) add(fmt::format("materials.{}.density", m.name), m.density);
        std::string names;
        for (const ParticleGroup& g : s.particles) names += g.name + ' ';
        add("particles (names and their order)", names);
        for (const ParticleGroup& g : s.particles) add_group("particles." + g.name + '.', g);
        for (const ParticleStream& stream : s.streams) add_stream("streams." + stream.name + '.', stream);
    }

    /// A stream that has begun keeps its numbers; when and after how much it ends may change.
    void add_stream(const std::string& table, const ParticleStream& s) {
        add(table + "material", s.material);
        add(table + "rate", fmt::format("{} {}", s.rate.particles, s.rate.mass));
        add(table + "start", s.start);
        add_size(table, s.size);
    }

    void add_flow(const std::string& table, const ParticleStream& s) {
        add(table + "total", fmt::format("{} {}", s.total.particles, s.total.mass));
        add(table + "stop", s.stop);
        add(table + "interval", s.interval);
        add(table + "attempts", fmt::format("{}", s.attempts));
        add(table + "velocity", s.velocity);
        add(table + "velocity_spread", s.velocity_spread);
        add(table + "angular_velocity", s.angular_velocity);
        add(table + "type", fmt::format("{}", s.inlet.index()));
        if (const auto* box = std::get_if<Box>(&s.inlet)) return add_box(table.substr(0, table.size() - 1), *box);
        const auto& inlet = std::get<InletSurface>(s.inlet);
        add(table + "mesh", inlet.mesh);
        add(table + "depth", inlet.depth);
        add(table + "scale", inlet.surface.scale);
        add(table + "rotation", inlet.surface.rotation);
        add(table + "translation", inlet.surface.translation);
        add_box(table.substr(0, table.size() - 1), inlet.facets);
    }

    void add_removal(const std::string& table, const Removal& r) {
        add(table + "type", fmt::format("{}", static_cast<int>(r.region)));
        if (r.region == RemovalRegion::box) add_box(table.substr(0, table.size() - 1), r.box);
        if (r.region == RemovalRegion::half_space) add(table + "point", r.point), add(table + "normal", r.normal);
        add(table + "steps", fmt::format("{}", r.steps));
    }

    void add_box(const std::string& table, const std::optional<Box>& box) {
        if (!box) return;
        add(table + ".lower", box->lower);
        add(table + ".upper", box->upper);
    }

    void add_group(const std::string& table, const ParticleGroup& g) {
        add(table + "type", fmt::format("{}", g.placement.index()));
        add(table + "material", g.material);
        add(table + "velocity", g.velocity);
        add(table + "angular_velocity", g.angular_velocity);
        if (const auto* lattice = std::get_if<Lattice>(&g.placement)) add_lattice(table, *lattice);
        if (const auto* list = std::get_if<ParticleList>(&g.placement)) add_list(table, *list);
        if (const auto* fill = std::get_if<RandomFill>(&g.placement)) {
            add_box(table.substr(0, table.size() - 1), fill->box);
            add(table + "count", fmt::format("{}", fill->count));
            add(table + "solid_fraction", fill->solid_fraction);
        }
        if (const auto* release = std::get_if<Release>(&g.placement)) {
            add(table + "spacing", release->spacing);
            add(table + "count", fmt::format("{}", release->count));
            add(table + "jitter", release->jitter);
            add(table + "radius", release->radius);
            add(table + "thickness", release->thickness);
        }
        add_size(table, g.size);
    }

    void add_lattice(const std::string& table, const Lattice& l) {
        add(table + "count", fmt::format("{}", fmt::join(l.count, ", ")));
        add(table + "spacing", l.spacing);
        add(table + "origin", l.origin);
        add(table + "jitter", l.jitter);
    }

    void add_list(const std::string& table, const ParticleList& l) {
        add(table + "positions", l.positions);
        add(table + "radii", l.radii);
        add(table + "velocities", l.velocities);
        add(table + "angular_velocities", l.angular_velocities);
    }

    void add_size(const std::string& table, const SizeDistribution& s) {
        add(table + "size", fmt::format("{}", static_cast<int>(s.law)));
        add(table + "radius", s.radius);
        add(table + "radius_minimum", s.minimum);
        add(table + "radius_maximum", s.maximum);
        add(table + "radius_mean", s.mean);
        add(table + "radius_deviation", s.deviation);
        if (!s.radii.empty()) add(table + "radii", s.radii);
        if (!s.weights.empty()) add(table + "weights", s.weights);
    }

    void add_acting(const Scene& s) {
        add("simulation.gravity", s.gravity);
        const auto& p = s.domain.periodic;
        if (!p[0] && !p[1] && !p[2]) add_box("domain", s.domain.box);
        add("contact.law", s.contact.law);
        add("contact.mixing", fmt::format("{}", static_cast<int>(s.contact.mixing)));
        add("contact.mass_damping", s.contact.mass_damping);
        for (const Material& m : s.materials) add_contact("materials." + m.name + '.', m);
        for (const PairRow& row : s.pairs) {
            const auto [a, b] = std::minmax(row.materials[0], row.materials[1]);
            add_contact(fmt::format("pairs ({} with {}) ", a, b), row);
        }
        for (const Plane& plane : s.planes) add_plane("planes." + plane.name + '.', plane);
        for (const Mesh& mesh : s.meshes) add_mesh("meshes." + mesh.name + '.', mesh);
        for (const ParticleStream& stream : s.streams) add_flow("streams." + stream.name + '.', stream);
        for (const Removal& removal : s.removals) add_removal("removals." + removal.name + '.', removal);
        if (!s.terrain) return;
        add("terrain.material", s.terrain->material);
        add("terrain.smooth", fmt::format("{}", s.terrain->smooth));
        add("terrain.edge", fmt::format("{}", static_cast<int>(s.terrain->edge)));
    }

    void add_mesh(const std::string& table, const Mesh& m) {
        add(table + "material", m.material);
        add(table + "scale", m.scale);
        add(table + "rotation", m.rotation);
        add(table + "translation", m.translation);
        add_motion(table, m.motion);
    }

    template <class Values>
    void add_contact(const std::string& table, const Values& m) {
        add(table + "normal_stiffness", m.normal_stiffness);
        add(table + "tangential_stiffness", m.tangential_stiffness);
        add(table + "friction", m.friction);
        add(table + "normal_damping", m.normal_damping);
        add(table + "tangential_damping", m.tangential_damping);
    }

    void add_plane(const std::string& table, const Plane& p) {
        add(table + "material", p.material);
        add(table + "point", p.point);
        add(table + "normal", p.normal);
        add_motion(table, p.motion);
    }

    void add_motion(const std::string& table, const Motion& m) {
        add(table + "motion.velocity", m.velocity);
        add(table + "motion.rotation", std::vector<Vec3d>{m.rotation_axis, m.rotation_point, {m.rotation_rate, 0, 0}});
        add(table + "motion.oscillation", std::vector<Vec3d>{m.oscillation_amplitude, {m.oscillation_frequency, m.oscillation_phase, 0}});
        add(table + "motion.start", m.start);
        add(table + "motion.stop", m.stop);
        for (const Waypoint& w : m.path) add(table + fmt::format("motion.path at {} s", w.time), w.shift);
    }

    std::map<std::string, std::string> all_;
};

/// A density of a material that only one of the two scenes has does nothing; a stream may begin or be left out.
bool matters(const std::string& key, bool in_both, bool kept) {
    return in_both || !((key.starts_with("materials.") && key.ends_with(".density")) || (kept && key.starts_with("streams.")));
}

std::vector<std::string> differing_keys(const Scene& then, const Scene& now, bool kept) {
    const auto a = Facts(then, kept).all(), b = Facts(now, kept).all();
    std::vector<std::string> keys;
    for (const auto& [key, value] : a) {
        const auto other = b.find(key);
        if ((other == b.end() || other->second != value) && matters(key, other != b.end(), kept)) keys.push_back(key);
    }
    for (const auto& [key, value] : b)
        if (!a.contains(key) && matters(key, false, kept)) keys.push_back(key);
    return keys;
}

/// What --set changed stands below the text that a program which uses the library keeps.
std::vector<std::string> overrides_below(const std::string& text) {
    constexpr std::string_view mark = "# --set ";
    std::vector<std::string> settings;
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        if (line.starts_with(mark)) settings.emplace_back(line.substr(mark.size()));
        rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    }
    return settings;
}

/// The scene of a checkpoint; none where a program without a scene file made it.
std::optional<Scene> scene_of(const Checkpoint& c) {
    if (c.scene.empty()) return {};
    try {
        return parse_scene(c.scene, "scene of the checkpoint", overrides_below(c.scene));
    } catch (const InputError&) {
        return {};
    }
}

/// Past eight keys the rest are counted.
std::string key_list(std::vector<std::string> keys) {
    constexpr std::size_t shown = 8;
    const std::size_t more = keys.size() > shown ? keys.size() - shown : 0;
    keys.resize(keys.size() - more);
    return fmt::format("{}", fmt::join(keys, ", ")) + (more ? fmt::format(" and {} more", more) : "");
}

}  // namespace

void require_fit(const Scene& scene, const InitialState& particles, const Checkpoint& c, const fs::path& file) {
    const auto reject = [&](const std::string& why) { throw InputError(fmt::format("--restart {}: {}", file.string(), why)); };
    if (c.placed != particles.size())
        reject(fmt::format("its run began with {} particles and the scene has {}; give the scene it was made with (scene.toml beside it)", c.placed, particles.size()));
    if (c.dt != scene.dt)
        reject(fmt::format("its time step is {} s and the scene's {} s; restart with the same one: --set simulation.dt={}", c.dt, scene.dt, c.dt));
    for (const std::uint32_t m : c.material)
        if (m >= scene.materials.size())
            reject(fmt::format("it uses material number {} and the scene has {}; give the scene it was made with", m + 1, scene.materials.size()));
    for (std::size_t k = 0; k < c.id.size(); ++k)
        if (c.id[k] < particles.size() && c.material[k] != particles.materials[c.id[k]])
            reject(fmt::format("particle {} is of material '{}' in it and of '{}' in the scene; give the scene it was made with", c.id[k],
                               scene.materials[c.material[k]].name, scene.materials[particles.materials[c.id[k]]].name));
    for (const std::uint32_t plane : c.wall_plane)
        if (plane >= scene.planes.size())
            reject(fmt::format("it uses plane number {} and the scene has {}; give the scene it was made with", plane + 1, scene.planes.size()));

    const std::optional<Scene> then = scene_of(c);
    if (!then) return;
    if (const auto keys = differing_keys(*then, scene, true); !keys.empty())
        reject(fmt::format("it was made with another {}, which cannot change on the way; leave the key as in the checkpoint's scene (scene.toml beside it), or start a new run",
                           key_list(keys)));
    for (std::size_t k = 0; k < c.id.size(); ++k)  // files of positions: their path may change, their content may not
        if (c.id[k] < particles.size() && std::abs(c.radius[k] - particles.radii[c.id[k]]) > 1e-4 * c.radius[k])
            reject(fmt::format("particle {} has a radius of {:.6g} m in it and of {:.6g} m in the scene; give the file of particles it was made with, or start a new run",
                               c.id[k], c.radius[k], particles.radii[c.id[k]]));
    for (const std::uint32_t k : c.wall_plane)
        if (k < then->planes.size() && then->planes[k].name != scene.planes[k].name)
            reject(fmt::format("plane {} is '{}' in it and '{}' in the scene, and particles touch it; keep the names and their order, or start a new run", k + 1,
                               then->planes[k].name, scene.planes[k].name));
}

void inspect_restart(const Scene& scene, const Checkpoint& c, const RunRange& range, Preflight& p) {
    if (const std::optional<Scene> then = scene_of(c))
        if (const auto keys = differing_keys(*then, scene, false); !keys.empty())
            p.findings.push_back({Weight::warning, fmt::format("from step {} on the scene is another than in the checkpoint: {}", c.step, key_list(keys))});
    if (!range.asked && c.step >= scene.steps())
        p.findings.push_back({Weight::note, fmt::format("the checkpoint is at step {} and the scene ends at step {}, so no step is left; raise simulation.duration or give --steps",
                                                        c.step, scene.steps())});
}

}  // namespace grainray::cli
