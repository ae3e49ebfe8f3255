#include "preflight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "arguments.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

constexpr double risky_step = 0.9;     // share of the critical time step
constexpr double risky_overlap = 0.3;  // of the smaller radius: such grains fly apart
constexpr double whole_tolerance = 1e-6;  // within it a number of steps counts as whole
constexpr double placing_bytes = 100;  // a particle, before the simulation takes it

void warn(Preflight& p, std::string text) { p.findings.push_back({Weight::warning, std::move(text)}); }
void refuse(Preflight& p, std::string text) { p.findings.push_back({Weight::refused, std::move(text)}); }
void note(Preflight& p, std::string text) { p.findings.push_back({Weight::note, std::move(text)}); }

/// True for 3, 3.0000001 and the like.
bool is_whole(double steps) { return std::abs(steps - std::round(steps)) <= whole_tolerance * std::max(steps, 1.0); }

void inspect_duration(const Scene& scene, Preflight& p) {
    const double steps = scene.duration / scene.dt;
    if (scene.duration > 0 && scene.steps() == 0)
        return refuse(p, fmt::format("simulation.duration = {} s is less than half a step of {} s, so there is no step to run; raise it, or make it 0 for the start alone",
                                     scene.duration, scene.dt));
    if (!is_whole(steps))
        note(p, fmt::format("simulation.duration = {} s is {:.10g} steps of {} s; {} are run, to t = {:.10g} s", scene.duration, steps, scene.dt,
                            scene.steps(), static_cast<double>(scene.steps()) * scene.dt));
}

void inspect_interval(const char* key, double interval, double dt, Preflight& p) {
    if (!(interval > 0)) return;
    const double steps = interval / dt;
    if (steps < 1 - whole_tolerance) warn(p, fmt::format("{} = {} s is shorter than simulation.dt = {} s; it is written every step", key, interval, dt));
    else if (!is_whole(steps))
        note(p, fmt::format("{} = {} s is {:.10g} steps; it is written every {:.0f} steps, {:.10g} s", key, interval, steps, std::round(steps), std::round(steps) * dt));
}

void inspect_intervals(const Scene& scene, Preflight& p) {
    inspect_interval("output.frames", scene.output.frames, scene.dt, p);
    inspect_interval("output.history", scene.output.history, scene.dt, p);
    inspect_interval("output.checkpoints", scene.output.checkpoints, scene.dt, p);
}

void inspect_steps(const Scene& scene, Preflight& p) {
    for (const CriticalStep& step : p.steps) {  // smallest critical step first
        const StepVerdict v = verdict(step, scene.dt);
        if (v == StepVerdict::ok) return;
        const std::string text = fmt::format("simulation.dt = {:.4g} s is {} critical time step of {:.4g} s of {}; lower {} or simulation.dt", scene.dt,
                                             v == StepVerdict::risky ? "close to the" : "above the", step.critical_dt, step.contact, step.field);
        return v == StepVerdict::risky ? warn(p, text) : refuse(p, text);
    }
}

void inspect_overlaps(const Scene& scene, Preflight& p) {
    const double limit = scene.limits.overlap;
    if (const auto& w = p.overlaps.worst_pair; w && w->ratio > risky_overlap) {
        const std::string text = fmt::format("particles {} and {} start {:.4g} m inside each other, {:.3g} of the smaller radius", w->a, w->b, w->overlap, w->ratio);
        if (w->ratio > limit) refuse(p, fmt::format("{}, past limits.overlap = {:.4g}; move them apart", text, limit));
        else warn(p, text + ": they will fly apart");
    }
    if (const auto& w = p.overlaps.worst_plane; w && w->ratio > risky_overlap) {
        const std::string text = fmt::format("particle {} starts {:.4g} m inside plane '{}', {:.3g} of its radius", w->particle, w->overlap,
                                             scene.planes[w->plane].name, w->ratio);
        if (w->ratio > limit) refuse(p, fmt::format("{}, past limits.overlap = {:.4g}; move it, or turn the plane's normal around", text, limit));
        else warn(p, text + ": it will fly off");
    }
}

void inspect_surface_overlaps(const Scene& scene, Preflight& p) {
    if (const auto& i = p.overlaps.below_terrain)
        refuse(p, fmt::format("particle {} starts under the ground; lift it, or move the terrain", *i));
    const auto& w = p.overlaps.worst_surface;
    if (!w || w->ratio <= risky_overlap) return;
    const std::string text = fmt::format("particle {} starts {:.4g} m inside {}, {:.3g} of its radius", w->particle, w->overlap, w->surface, w->ratio);
    if (w->ratio > scene.limits.overlap) refuse(p, fmt::format("{}, past limits.overlap = {:.4g}; move it", text, scene.limits.overlap));
    else warn(p, text + ": it will fly off");
}

double largest_extent(const Box& box) { return std::max({box.extent().x, box.extent().y, box.extent().z}); }

void inspect_meshes(const Scene& scene, const InitialState& s, Preflight& p) {
    const std::optional<Box> world = scene.domain.box ? scene.domain.box : bounds(s);
    for (const Mesh& mesh : scene.meshes) {
        MeshReport r;
        load_mesh(scene, mesh, &r);
        const std::string key = "meshes." + mesh.name;
        if (r.degenerate || r.duplicates)
            note(p, fmt::format("{}.file: {} triangles without area and {} duplicates are left out", key, r.degenerate, r.duplicates));
        if (r.reversed) note(p, fmt::format("{}.file: {} triangles face the other way than their neighbours; they are turned over", key, r.reversed));
        if (r.slivers) warn(p, fmt::format("{}.file: {} triangles are slivers, a thousand times as long as high; mesh the surface anew", key, r.slivers));
        if (r.crowded_edges) warn(p, fmt::format("{}.file: {} edges belong to three triangles or more, so one side of the surface cannot be told from the other there", key, r.crowded_edges));
        if (r.parts > 10 && r.free_edges > r.triangles)
            warn(p, fmt::format("{}.file is a soup of {} pieces with {} free edges: its triangles do not share corners; merge them in a mesh program", key, r.parts, r.free_edges));
        const double size = largest_extent(r.bounds), there = world ? largest_extent(*world) : 0;
        if (there > 0 && (size > 300 * there || size < there / 300))
            warn(p, fmt::format("mesh '{}' is {:.3g} m large and {} {:.3g} m; if its file is in other units than metres, give {}.scale (0.001 for millimetres)", mesh.name, size,
                                scene.domain.box ? "the domain" : "what the particles take up", there, key));
    }
}

void inspect_speeds(const Scene& scene, const InitialState& s, Preflight& p) {
    if (s.velocities.empty()) return;
    const double smallest = *std::min_element(s.radii.begin(), s.radii.end());
    const double limit = scene.limits.speed > 0 ? scene.limits.speed : smallest / scene.dt;
    for (std::size_t i = 0; i < s.velocities.size(); ++i)
        if (const double speed = length(s.velocities[i]); speed > limit)
            return refuse(p, fmt::format("particle {} starts at {:.4g} m/s, past the limit of {:.4g} m/s (limits.speed; the smallest radius a step where it "
                                         "is not given); lower simulation.dt", i, speed, limit));
}

void inspect_memory(Preflight& p) {
    const double there = machine_memory_bytes();
    if (there > 0 && p.needs.peak_bytes > there)
        warn(p, fmt::format("the run is forecast to need {} at its peak and this machine has {}", bytes_text(p.needs.peak_bytes), bytes_text(there)));
}

}  // namespace

StepVerdict verdict(const CriticalStep& step, double dt) {
    const double ratio = dt / step.critical_dt;
    return ratio >= 1 ? StepVerdict::unstable : ratio > risky_step ? StepVerdict::risky : StepVerdict::ok;
}

const Finding* Preflight::first_refusal() const {
    const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& f) { return f.weight == Weight::refused; });
    return found == findings.end() ? nullptr : &*found;
}

std::size_t Preflight::warnings() const {
    return static_cast<std::size_t>(std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.weight == Weight::warning; }));
}

InitialState place_checked(const Scene& scene) {
    double count = 0;
    for (const double c : expected_counts(scene)) count += c;
    const double needed = count * placing_bytes, there = machine_memory_bytes();
    if (count > 4294967295.0) throw InputError(fmt::format("the scene places {:.4g} particles; at most 4294967295 can be numbered", count));
    if (there > 0 && needed > there)
        throw InputError(fmt::format("the scene places {:.4g} particles: placing them alone needs {} and this machine has {}; use fewer", count,
                                     bytes_text(needed), bytes_text(there)));
    return place_particles(scene);
}

std::uint64_t RunRange::last(const Scene& scene) const { return asked ? first + *asked : std::max(first, scene.steps()); }

Preflight inspect(const Scene& scene, const InitialState& s, const RunRange& range) {
    Preflight p;
    p.needs = forecast(scene, static_cast<double>(s.size()), range.last(scene) - range.first);
    if (!range.asked) inspect_duration(scene, p);
    inspect_intervals(scene, p);
    inspect_meshes(scene, s, p);
    if (s.size() == 0) {
        warn(p, "the scene has no particles: nothing will move");
        return p;
    }
    p.steps = critical_steps(scene, s);
    inspect_steps(scene, p);
    if (!range.restarted) {
        p.overlaps = initial_overlaps(scene, s);
        inspect_overlaps(scene, p);
        inspect_surface_overlaps(scene, p);
        inspect_speeds(scene, s, p);
    }
    inspect_memory(p);
    return p;
}

void insist(const Preflight& p, bool quiet) {
    if (const Finding* refusal = p.first_refusal()) throw InputError(refusal->text);
    for (const Finding& finding : p.findings)
        if (!quiet) fmt::print(stderr, "grainray: {}: {}\n", finding.weight == Weight::note ? "note" : "warning", finding.text);
}

void inspect_disk(const std::filesystem::path& folder, Preflight& p) {
    std::error_code error;
    std::filesystem::path there = std::filesystem::absolute(folder, error);
    while (!there.empty() && !std::filesystem::exists(there, error) && there != there.parent_path()) there = there.parent_path();
    const auto space = std::filesystem::space(there, error);
    if (!error && p.needs.disk_bytes > static_cast<double>(space.available))
        warn(p, fmt::format("the output is forecast to take {} and {} are free; raise output.frames or select fewer output.fields",
                            bytes_text(p.needs.disk_bytes), bytes_text(static_cast<double>(space.available))));
}

}  // namespace grainray::cli
