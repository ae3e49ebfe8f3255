#include "summary.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report.hpp"

namespace grainray::cli {

std::string hash_text(std::uint64_t hash) { return fmt::format("0x{:016x}", hash); }

nlohmann::ordered_json profile_json(const Profile& p) {
    return {{"neighbors", p.neighbors}, {"contacts", p.contacts}, {"boundary", p.boundary}, {"dynamics", p.dynamics}, {"fused", p.fused}, {"insertion", p.insertion}, {"output", p.output}};
}

nlohmann::ordered_json search_json(const SearchReport& s) {
    return {{"backend", s.backend},
            {"reason", s.reason},
            {"rebuilds", s.rebuilds},
            {"mean_interval_steps", s.mean_interval_steps},
            {"mean_neighbors", s.mean_neighbors},
            {"mean_margin_ratio", s.mean_margin_ratio}};
}

void add_speed(nlohmann::ordered_json& json, std::uint64_t particle_steps, std::uint64_t steps, double wall_seconds) {
    const auto rate = [=](std::uint64_t count) { return wall_seconds > 0 ? static_cast<double>(count) / wall_seconds : 0; };
    json["wall_seconds"] = wall_seconds;
    json["steps_per_second"] = rate(steps);
    json["particle_steps_per_second"] = rate(particle_steps);
}

Exchanged exchanged_by(const Simulation& simulation) {
    Exchanged sum;
    for (const StreamReport& s : simulation.streams()) sum.inserted += s.inserted, sum.waiting += s.waiting;
    for (const RemovalReport& r : simulation.removals()) (r.of_terrain ? sum.lost : sum.removed) += r.particles;
    return sum;
}

namespace {

/// Totals, then each stream and removal.
void add_exchanges(nlohmann::ordered_json& json, const Simulation& simulation, const Scene& scene) {
    const Exchanged all = exchanged_by(simulation);
    if (scene.terrain) json["particles_lost"] = all.lost;
    if (!scene.streams.empty()) {
        json["particles_inserted"] = all.inserted;
        json["particles_waiting"] = all.waiting;
        for (const StreamReport& s : simulation.streams())
            json["streams"][s.name] = {{"inserted", s.inserted}, {"mass", s.mass}, {"waiting", s.waiting}, {"waiting_mass", s.waiting_mass}};
    }
    if (scene.removals.empty()) return;
    json["particles_removed"] = all.removed;
    for (const RemovalReport& r : simulation.removals())
        if (!r.of_terrain) json["removals"][r.name] = {{"removed", r.particles}, {"mass", r.mass}};
}

}  // namespace

std::string summary_text(const Simulation& simulation, const Scene& scene, const RunFacts& facts) {
    const Statistics now = simulation.statistics();
    const std::uint64_t steps = simulation.step_count() - facts.first_step;
    nlohmann::ordered_json json;
    json["version"] = GRAINRAY_VERSION;
    json["status"] = facts.status;
    if (!facts.message.empty()) json["message"] = facts.message;
    json["title"] = scene.title;
    json["device"] = std::string(name(simulation.device()));
    json["device_reason"] = facts.device_reason;
    json["threads"] = facts.threads;
    json["method"] = scene.method;
    json["particles"] = simulation.size();
    add_exchanges(json, simulation, scene);
    json["dt"] = scene.dt;
    json["steps"] = steps;
    json["step"] = simulation.step_count();
    json["time"] = simulation.time();
    add_speed(json, simulation.particle_steps(), steps, facts.wall_seconds);
    json["search"] = search_json(simulation.search());
    json["profile"] = profile_json(simulation.profile());
    json["memory_bytes"] = simulation.memory_bytes();
    if (simulation.device() == Device::cuda)
        json["device_memory"] = {{"forecast_bytes", std::llround(facts.device_forecast_bytes)}, {"peak_bytes", cuda_peak_bytes()}};
    json["energy"] = {{"kinetic", now.kinetic_translation + now.kinetic_rotation}, {"potential", now.potential}};
    json["max_overlap_ratio"] = now.max_overlap_ratio;
    json["state_hash"] = hash_text(simulation.state_hash());
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace grainray::cli
