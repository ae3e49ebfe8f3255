// grainray bench step: the time of a step, stage by stage.
#include <chrono>
#include <cstdio>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "column_scene.hpp"
#include "command.hpp"
#include "grainray/output.hpp"
#include "preflight.hpp"
#include "report.hpp"
#include "setup.hpp"

namespace grainray::cli {
namespace {

constexpr std::int64_t collapse_steps = 4000, settled_steps = 2000, settled_warmup = 200;

struct Options {
    std::string scene = "collapse";
    std::filesystem::path init, json;
    EngineOptions engine;
    std::optional<std::int64_t> steps, warmup;
};

Scene scene_for(const Options& options) {
    const bool built_in = options.scene == "collapse" || options.scene == "settled";
    if (options.scene == "settled" && options.init.empty())
        throw InputError("--scene settled needs the positions of a settled bed: --init FILE.csv with columns x y z radius [vx vy vz]");
    if (!built_in && !options.scene.ends_with(".toml")) require_choice("--scene", options.scene, {"collapse", "settled", "FILE.toml"});
    Scene scene = built_in ? parse_scene(column_scene, "column_collapse.toml", options.engine.set) : load_scene(options.scene, options.engine.set);
    if (options.init.empty()) return scene;
    if (scene.particles.empty()) throw InputError("--init: the scene has no group of particles to take the material from");
    scene.particles.resize(1);
    scene.particles[0].placement = ParticleFile{std::filesystem::absolute(options.init)};
    scene.particles[0].velocity = scene.particles[0].angular_velocity = {};
    return scene;
}

struct Measured {
    std::uint64_t steps;
    double wall_seconds;
    Profile profile;
    SearchReport search;
};

/// Time since it was made: of the clock, and of the processor, all threads together.
struct Stopwatch {
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::clock_t processor = std::clock();
    nlohmann::ordered_json json() const {
        return {{"seconds", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()},
                {"processor_seconds", static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC}};
    }
};

Measured measure(Simulation& simulation, std::int64_t warmup, std::int64_t steps) {
    simulation.run(static_cast<std::uint64_t>(warmup));
    const SearchReport before = simulation.search();
    simulation.profile() = {};
    const auto start = std::chrono::steady_clock::now();
    simulation.run(static_cast<std::uint64_t>(steps));
    Measured m{static_cast<std::uint64_t>(steps), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
               simulation.profile(), simulation.search()};
    simulation.check_health();
    m.search.rebuilds -= before.rebuilds;
    m.search.mean_interval_steps = m.search.rebuilds ? static_cast<double>(steps) / static_cast<double>(m.search.rebuilds) : 0;
    return m;
}

/// Bytes that cross the GPU's memory bus in a fused step at the least, a particle: state read and written (near 16, far 12,
/// body 32, remainder 12, twice), position of the last build and frame (28), where its rows begin (12), 4 an entry of its
/// row, and 12 read and 12 written a contact, of which each of two particles keeps its own history.
double fused_bytes(const SearchReport& search, const Statistics& statistics) {
    return 2 * 72 + 28 + 12 + 4 * search.mean_neighbors + 24 * statistics.coordination;
}

/// Bytes a second, read and written, of the best of ten copies of half a gibibyte within the GPU.
double copy_bandwidth() {
    constexpr std::size_t bytes = std::size_t{1} << 29;
    Array<char> from(Device::cuda, bytes), to(Device::cuda, bytes);
    from.clear_bytes();
    double best = 1e300;
    for (int repeat = 0; repeat < 10; ++repeat) {
        char last = 0;
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < 4; ++k) detail::copy(Device::cuda, to.data(), Device::cuda, from.data(), bytes);
        detail::copy(Device::cpu, &last, Device::cuda, to.data() + bytes - 1, 1);
        best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 4);
    }
    return 2 * static_cast<double>(bytes) / best;
}

/// How near the fused step is to the speed of a copy.
nlohmann::ordered_json traffic_json(const Simulation& simulation, const Measured& m, double copy) {
    const double bytes = fused_bytes(m.search, simulation.statistics()) * static_cast<double>(simulation.size());
    const double seconds = m.profile.fused / static_cast<double>(m.steps);
    return {{"copy_bytes_per_second", copy}, {"fused_bytes_per_step", bytes}, {"fused_bytes_per_second", bytes / seconds},
            {"share_of_copy", bytes / seconds / copy}};
}

nlohmann::ordered_json report(const Simulation& simulation, const Options& options, const Measured& m, double device_forecast) {
    nlohmann::ordered_json json;
    const double n = static_cast<double>(std::max<std::size_t>(simulation.size(), 1));
    json["version"] = GRAINRAY_VERSION;
    json["benchmark"] = "step";
    json["scene"] = options.scene;
    json["particles"] = simulation.size();
    json["steps"] = m.steps;
    add_speed(json, simulation.size() * m.steps, m.steps, m.wall_seconds);
    json["threads"] = ThreadLimit::count();
    json["device"] = std::string(name(simulation.device()));
    json["profile"] = profile_json(m.profile);
    json["search"] = search_json(m.search);
    json["memory_bytes"] = simulation.memory_bytes();
    json["bytes_per_particle"] = static_cast<double>(simulation.memory_bytes()) / n;
    json["peak_rss_bytes"] = peak_resident_bytes();
    if (simulation.device() == Device::cuda) {
        json["gpu"] = cuda_status();
        json["device_forecast_bytes_per_particle"] = device_forecast / n;
        json["device_peak_bytes_per_particle"] = static_cast<double>(cuda_peak_bytes()) / n;
    }
    return json;
}

void print_table(const nlohmann::ordered_json& json, const Measured& m) {
    const double steps = static_cast<double>(std::max<std::uint64_t>(m.steps, 1));
    fmt::print("{}: {}, {} on {} with {} threads, search {}\n", json["scene"].get<std::string>(), counted(json["particles"].get<std::uint64_t>(), "particle"),
               counted(m.steps, "step"), json["device"].get<std::string>(), json["threads"].get<int>(), m.search.backend);
    fmt::print("  {:<10} {:>10} {:>7}\n", "stage", "ms a step", "share");
    double rest = m.wall_seconds;
    for (const auto& [stage, value] : json["profile"].items()) {
        const double seconds = value.get<double>();
        rest -= seconds;
        fmt::print("  {:<10} {:>10.4f} {:>6.1f}%\n", stage, 1e3 * seconds / steps, 100 * seconds / m.wall_seconds);
    }
    fmt::print("  {:<10} {:>10.4f} {:>6.1f}%\n", "rest", 1e3 * rest / steps, 100 * rest / m.wall_seconds);
    fmt::print("  {:<10} {:>10.4f}\n", "whole", 1e3 * m.wall_seconds / steps);
    fmt::print("{:.4g} million particle-steps/s; rebuild every {:.3g} steps, {:.3g} neighbours in the list of a particle; {:.0f} bytes a particle, {} at the peak\n",
               json["particle_steps_per_second"].get<double>() / 1e6, m.search.mean_interval_steps, m.search.mean_neighbors,
               json["bytes_per_particle"].get<double>(), bytes_text(json["peak_rss_bytes"].get<double>()));
    if (!json.contains("traffic")) return;
    const auto& t = json["traffic"];
    fmt::print("{}: {:.0f} bytes a particle at the peak, {:.0f} forecast; a fused step must move {:.0f} bytes a particle: {:.2f} TB/s, {:.0f}% of the {:.2f} TB/s of a copy\n",
               json["gpu"].get<std::string>(), json["device_peak_bytes_per_particle"].get<double>(), json["device_forecast_bytes_per_particle"].get<double>(),
               t["fused_bytes_per_step"].get<double>() / json["particles"].get<double>(), t["fused_bytes_per_second"].get<double>() / 1e12,
               100 * t["share_of_copy"].get<double>(), t["copy_bytes_per_second"].get<double>() / 1e12);
}

int bench_step(const Options& options) {
    const bool settled = options.scene == "settled";
    const std::int64_t steps = options.steps.value_or(settled ? settled_steps : collapse_steps);
    const std::int64_t warmup = options.warmup.value_or(settled ? settled_warmup : 0);
    require_steps("--steps", steps, 1);
    require_steps("--warmup", warmup, 0);
    require_writable("--json", options.json);
    const ThreadLimit limit(options.engine.threads);
    const Scene scene = scene_for(options);
    const Engine engine = choose_engine(options.engine, scene);
    const InitialState initial = place_checked(scene);
    Preflight preflight = inspect(scene, initial);
    inspect_device(scene, initial, engine.options, preflight);
    const Stopwatch whole;
    Simulation simulation(scene, initial, engine.options);
    const Measured m = measure(simulation, warmup, steps);
    const auto start_and_steps = whole.json();
    auto json = report(simulation, options, m, preflight.device_bytes());
    json["start_and_steps"] = start_and_steps;
    if (simulation.device() == Device::cuda) json["traffic"] = traffic_json(simulation, m, copy_bandwidth());
    print_table(json, m);
    if (!options.json.empty()) write_text_atomically(options.json, json.dump(2) + '\n');
    return done;
}

}  // namespace

void add_bench_step(CLI::App& bench, Action& chosen) {
    Command command(bench, chosen, "step", "Time of a step, stage by stage");
    const auto options = std::make_shared<Options>();
    command.option_with_default("--scene", options->scene, "NAME|FILE.toml",
                                "collapse (20,160 grains, 4000 steps), settled (needs --init, 2000 steps after 200), or a scene file");
    command.option("--init", options->init, "FILE.csv", "Start from these particles: columns x y z radius [vx vy vz]");
    command.option("--steps", options->steps, "N", "Steps that are timed");
    command.option("--warmup", options->warmup, "N", "Steps before");
    command.option("--json", options->json, "FILE", "Write the figures to this file");
    command.engine_options(options->engine);
    command.footer("Example: grainray bench step --scene collapse --steps 500 --threads 1 --json step.json");
    command.action([options] { return bench_step(*options); });
}

}  // namespace grainray::cli
