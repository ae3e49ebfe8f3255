// grainray check: everything that can be said about a scene without running it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>

#include <fmt/format.h>

#include "arguments.hpp"
#include "command.hpp"
#include "preflight.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

constexpr int probe_steps = 20;
constexpr double probe_seconds = 0.3;

struct Options {
    std::filesystem::path scene;
    EngineOptions engine;
};

std::string vector_text(const Vec3d& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

/// Particles of each group: what the scene says, and for the others what placing them alone gives.
std::vector<double> group_counts(const Scene& scene, std::size_t total) {
    if (scene.particles.size() == 1) return {static_cast<double>(total)};
    std::vector<double> counts = expected_counts(scene);
    for (std::size_t g = 0; g < counts.size(); ++g) {
        if (counts[g] > 0) continue;
        Scene alone = scene;
        alone.particles = {scene.particles[g]};
        counts[g] = static_cast<double>(place_particles(alone).size());
    }
    return counts;
}

void print_particles(const Scene& scene, const InitialState& s) {
    fmt::print("particles    {}\n", s.size());
    const auto counts = group_counts(scene, s.size());
    for (std::size_t g = 0; g < counts.size(); ++g)
        fmt::print("  {:<16} {:.0f} of material {}\n", scene.particles[g].name, counts[g], scene.particles[g].material);
    std::map<std::uint32_t, std::size_t> of_material;
    for (const std::uint32_t m : s.materials) ++of_material[m];
    for (const auto& [m, count] : of_material) fmt::print("  material {:<7} {}\n", scene.materials[m].name, counted(count, "particle"));
    if (s.size() == 0) return;
    const auto [least, most] = std::minmax_element(s.radii.begin(), s.radii.end());
    const Box box = *bounds(s);
    fmt::print("radii        {:.6g} to {:.6g} m\n", *least, *most);
    fmt::print("bounds       {} to {} m\n", vector_text(box.lower), vector_text(box.upper));
    fmt::print("planes       {}\n", scene.planes.size());
}

std::string amount_text(const Amount& a) { return a.mass > 0 ? fmt::format("{:.6g} kg", a.mass) : fmt::format("{:.6g} particles", a.particles); }

void print_exchanges(const Scene& scene, const Preflight& p) {
    for (std::size_t k = 0; k < scene.streams.size(); ++k) {
        const ParticleStream& s = scene.streams[k];
        const StreamForecast& f = p.streams[k];
        fmt::print("stream       {}: {} of material {} a second{}, every {}; {:.0f} particles, {:.6g} kg by the end; solid fraction of the inlet {:.3g}\n", s.name, amount_text(s.rate),
                   s.material, s.total.given() ? fmt::format(" until {} have come", amount_text(s.total)) : "", counted(f.interval_steps, "step"), std::floor(f.particles), f.mass, f.fraction);
    }
    for (const Removal& r : scene.removals) fmt::print("removal      {}: looks every {}\n", r.name, counted(static_cast<std::uint64_t>(r.steps), "step"));
    if (!scene.streams.empty()) fmt::print("at the end   {:.0f} particles{}; memory and disk are forecast for these\n", p.most_particles, scene.removals.empty() ? "" : " less those taken out");
}

void print_surfaces(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        MeshReport r;
        load_mesh(scene, mesh, &r);
        fmt::print("mesh         {}: {} triangles, {} corners, {:.6g} m2, {} free edges, {} to {} m\n", mesh.name, r.triangles, r.vertices, r.area, r.free_edges,
                   vector_text(r.bounds.lower + mesh.translation), vector_text(r.bounds.upper + mesh.translation));
    }
    if (!scene.terrain) return;
    const ElevationGrid g = load_ground(scene);
    const auto holes = std::count_if(g.heights.begin(), g.heights.end(), [](double h) { return std::isnan(h); });
    fmt::print("terrain      {} x {} nodes, {:.6g} x {:.6g} m apart, from ({:.8g}, {:.8g}) m, {} holes\n", g.columns, g.rows, g.dx, g.dy, g.x, g.y, holes);
}

void print_overlaps(const Scene& scene, const Overlaps& o) {
    fmt::print("overlaps     {} pairs, {} with planes{} at the start\n", o.pairs, o.with_planes,
               scene.meshes.empty() && !scene.terrain ? "" : fmt::format(", {} with meshes and terrain", o.with_surfaces));
    if (const auto& w = o.worst_pair)
        fmt::print("  worst pair       particles {} and {}: {:.4g} m, {:.3g} of the smaller radius\n", w->a, w->b, w->overlap, w->ratio);
    if (const auto& w = o.worst_plane)
        fmt::print("  worst plane      particle {} in '{}': {:.4g} m, {:.3g} of its radius\n", w->particle, scene.planes[w->plane].name, w->overlap, w->ratio);
}

void print_surface_overlap(const Overlaps& o) {
    if (const auto& w = o.worst_surface)
        fmt::print("  worst surface    particle {} in {}: {:.4g} m, {:.3g} of its radius\n", w->particle, w->surface, w->overlap, w->ratio);
}

void print_steps(const Scene& scene, const std::vector<CriticalStep>& steps) {
    fmt::print("time step    {:.4g} s, {}\n", scene.dt, counted(scene.steps(), "step"));
    if (steps.empty()) return;
    std::size_t width = 7;
    for (const CriticalStep& step : steps) width = std::max(width, step.contact.size());
    fmt::print("  {:<{}}  critical dt  dt/critical  verdict   field to change\n", "contact", width);
    for (const CriticalStep& step : steps) {
        const StepVerdict v = verdict(step, scene.dt);
        fmt::print("  {:<{}}  {:<11.4g}  {:<11.3g}  {:<8}  {}\n", step.contact, width, step.critical_dt, scene.dt / step.critical_dt,
                   v == StepVerdict::ok ? "ok" : v == StepVerdict::risky ? "risky" : "unstable", step.field);
    }
}

void print_device_memory(const Preflight& p, double particles) {
    if (p.device.empty()) return;
    fmt::print("GPU memory   {} at most, {:.0f} bytes a particle; {} are free\n", bytes_text(p.device_bytes()), p.device_bytes() / particles,
               bytes_text(static_cast<double>(cuda_free_bytes())));
    for (const MemoryPart& part : p.device) fmt::print("  {:<24} {:>10}  {:>5.0f} bytes a particle\n", part.name, bytes_text(part.bytes), part.bytes / particles);
}

/// Runs the scene itself for a moment.
void print_probe(const Scene& scene, const InitialState& s, const Preflight& p, const Engine& engine) {
    Simulation simulation(scene, s, engine.options);
    using clock = std::chrono::steady_clock;
    const auto start = clock::now();
    double seconds = 0;
    int steps = 0;
    while (steps < probe_steps && seconds < probe_seconds) {
        simulation.step();
        ++steps;
        seconds = std::chrono::duration<double>(clock::now() - start).count();
    }
    const double per_step = seconds / steps, n = static_cast<double>(std::max<std::size_t>(s.size(), 1));
    fmt::print("device       {} ({}), {} threads\n", name(engine.options.device), engine.device_reason, ThreadLimit::count());
    fmt::print("memory       {} for the simulation{}, {} at most while writing\n", bytes_text(p.needs.memory_bytes),
               s.size() ? fmt::format(" ({:.0f} bytes a particle now)", static_cast<double>(simulation.memory_bytes()) / n) : "", bytes_text(p.needs.peak_bytes));
    fmt::print("disk         {} ({} a frame)\n", bytes_text(p.needs.disk_bytes), bytes_text(p.needs.frame_bytes));
    if (s.size() == 0) {
        fmt::print("wall time    not known: the run starts without a particle\n");
        return;
    }
    const bool loose = simulation.statistics().coordination < 1;
    fmt::print("wall time    about {} at the speed of the first {} steps, {} particle-steps/s{}\n", duration_text(per_step * static_cast<double>(scene.steps())),
               steps, short_number(n / per_step), loose ? "; 3 to 6 times as long once the grains lie on each other" : "");
    if (p.most_particles > n) fmt::print("             for the {} particles of the start; up to {:.0f} take longer\n", s.size(), p.most_particles);
}

int check(const Options& options) {
    const ThreadLimit limit(options.engine.threads);
    const Scene scene = load_scene(options.scene, options.engine.set);
    const Engine engine = choose_engine(options.engine, scene);
    const InitialState particles = place_checked(scene);
    Preflight preflight = inspect(scene, particles);
    inspect_disk(".", preflight);
    inspect_device(scene, particles, engine.options, preflight);
    fmt::print("scene        {}{}\n", options.scene.string(), scene.title.empty() ? "" : ": " + scene.title);
    print_particles(scene, particles);
    print_exchanges(scene, preflight);
    print_surfaces(scene);
    print_overlaps(scene, preflight.overlaps);
    print_surface_overlap(preflight.overlaps);
    print_steps(scene, preflight.steps);
    print_device_memory(preflight, std::max(preflight.most_particles, 1.0));
    if (!preflight.first_refusal()) print_probe(scene, particles, preflight, engine);
    for (const Finding& finding : preflight.findings) fmt::print("{:<12} {}\n", finding.weight == Weight::refused ? "refused" : finding.weight == Weight::note ? "note" : "warning", finding.text);
    if (const Finding* refusal = preflight.first_refusal()) {
        fmt::print("verdict      refused\n");
        std::fflush(stdout);
        throw InputError(refusal->text);
    }
    const std::size_t warnings = preflight.warnings();
    fmt::print("verdict      {}\n", warnings == 0 ? "ok" : fmt::format("can run, with {} warning{}", warnings, warnings == 1 ? "" : "s"));
    return done;
}

}  // namespace

void add_check(CLI::App& app, Action& chosen) {
    Command command(app, chosen, "check", "Validate a scene, forecast memory, time and stability; writes nothing");
    const auto options = std::make_shared<Options>();
    command.argument("SCENE", options->scene, "Scene file");
    command.engine_options(options->engine);
    command.footer("Example: grainray check examples/column_collapse_literal.toml --set simulation.dt=1e-3\n"
                    "Exit status 0: it can run, perhaps with warnings; 2: it is refused, and the message names the field to change.");
    command.action([options] { return check(*options); });
}

}  // namespace grainray::cli
