#include "preflight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

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

constexpr double full_inlet = 0.3;  // solid fraction that random insertion still reaches with ease

/// Takes a removal whatever appears in a region?
bool takes_all(const Removal& removal, const Box& inlet) {
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d x{(corner & 1 ? inlet.upper : inlet.lower).x, (corner & 2 ? inlet.upper : inlet.lower).y, (corner & 4 ? inlet.upper : inlet.lower).z};
        if (removal.region == RemovalRegion::half_space && !(dot(removal.normal, x - removal.point) > 0)) return false;
        for (int a = 0; a < 3 && removal.region == RemovalRegion::box; ++a)
            if (x[a] < removal.box.lower[a] || x[a] > removal.box.upper[a]) return false;
    }
    return removal.region != RemovalRegion::outside;
}

void inspect_stream(const Scene& scene, const ParticleStream& stream, const Feeder& feeder, const StreamForecast& f, double end, Preflight& p) {
    const std::string key = "streams." + stream.name;
    const double interval = static_cast<double>(f.interval_steps) * scene.dt, span = std::min(stream.stop, end) - stream.start;
    if (!(span > 0)) return note(p, fmt::format("{}.start = {} s is not before the end of the run at {:.6g} s; nothing comes", key, stream.start, end));
    if (f.fraction > full_inlet)
        warn(p, fmt::format("{}: {:.2f} of the inlet's volume would be solid and random places fill about {}; some particles will wait. Enlarge the inlet, raise the velocity or lower the rate",
                            key, f.fraction, full_inlet));
    if (interval > 0.25 * span)
        warn(p, fmt::format("{} inserts every {:.4g} s, {:.3g} times while it runs; give {}.interval for a steadier stream", key, interval, std::floor(span / interval), key));
    const double limit = scene.limits.speed > 0 ? scene.limits.speed : smallest_radius(stream.size) / scene.dt;
    if (const double speed = length(stream.velocity) + length(stream.velocity_spread); speed > limit)
        refuse(p, fmt::format("{}.velocity: particles come at up to {:.4g} m/s, past the limit of {:.4g} m/s (limits.speed; the smallest radius a step where it is not given); lower simulation.dt",
                              key, speed, limit));
    for (const Removal& removal : scene.removals)
        if (takes_all(removal, feeder.inlet().at(0)->bounds))
            refuse(p, fmt::format("removals.{} takes out everything that {} inserts; move one of them", removal.name, key));
}

void inspect_streams(const Scene& scene, const RunRange& range, Preflight& p) {
    for (const ParticleStream& stream : scene.streams) {
        const Feeder feeder(scene, stream, 0);
        p.streams.push_back(feeder.forecast(range.last(scene)));
        p.most_particles += std::floor(p.streams.back().particles);
        inspect_stream(scene, stream, feeder, p.streams.back(), static_cast<double>(range.last(scene)) * scene.dt, p);
    }
    if (p.most_particles > 4294967295.0)
        refuse(p, fmt::format("{:.4g} particles come until the end; at most 4294967295 can be numbered; lower a rate or give a total", p.most_particles));
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
    p.most_particles = static_cast<double>(s.size());
    inspect_streams(scene, range, p);
    p.needs = forecast(scene, p.most_particles, range.last(scene) - range.first);
    if (!range.asked) inspect_duration(scene, p);
    inspect_intervals(scene, p);
    inspect_meshes(scene, s, p);
    if (s.size() == 0 && scene.streams.empty()) {
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

double Preflight::device_bytes() const {
    return std::accumulate(device.begin(), device.end(), 0.0, [](double sum, const MemoryPart& part) { return sum + part.bytes; });
}

void inspect_device(const Scene& scene, const InitialState& s, const SimulationOptions& options, Preflight& p) {
    if (options.device != Device::cuda || !(p.most_particles > 0)) return;
    double triangles = 0, nodes = 0;
    for (const Mesh& mesh : scene.meshes) {
        MeshReport r;
        load_mesh(scene, mesh, &r);
        triangles += static_cast<double>(r.triangles);
    }
    if (scene.terrain) nodes = static_cast<double>(load_ground(scene).heights.size());
    p.device = forecast_device_memory(scene, p.most_particles, s.radii, options.backend, triangles, nodes);
    const auto text = device_refusal(p.device_bytes(), static_cast<double>(cuda_free_bytes()), p.most_particles);
    if (!text) return;
    if (scene.streams.empty() || scene.removals.empty()) refuse(p, *text);
    else warn(p, *text + "; the forecast counts those that will be taken out");
}

std::optional<std::string> device_refusal(double needed, double free, double particles) {
    if (needed <= free) return std::nullopt;
    return fmt::format("the run is forecast to need {} of GPU memory, {:.0f} bytes a particle, and {} are free; use at most {} particles, end what else uses "
                       "the GPU, or give --device cpu",
                       bytes_text(needed), needed / particles, bytes_text(free), short_number(particles * free / needed));
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
