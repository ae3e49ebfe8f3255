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
constexpr double placing_bytes = 100;  // a particle, before the simulation takes it

void warn(Preflight& p, std::string text) { p.findings.push_back({false, std::move(text)}); }
void refuse(Preflight& p, std::string text) { p.findings.push_back({true, std::move(text)}); }

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
    const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& f) { return f.refused; });
    return found == findings.end() ? nullptr : &*found;
}

std::size_t Preflight::warnings() const {
    return static_cast<std::size_t>(std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return !f.refused; }));
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

Preflight inspect(const Scene& scene, const InitialState& s, bool restarted) {
    Preflight p;
    p.needs = forecast(scene, static_cast<double>(s.size()));
    if (s.size() == 0) {
        warn(p, "the scene has no particles: nothing will move");
        return p;
    }
    p.steps = critical_steps(scene, s);
    inspect_steps(scene, p);
    if (!restarted) {
        p.overlaps = initial_overlaps(scene, s);
        inspect_overlaps(scene, p);
        inspect_speeds(scene, s, p);
    }
    inspect_memory(p);
    return p;
}

void insist(const Preflight& p, bool quiet) {
    if (const Finding* refusal = p.first_refusal()) throw InputError(refusal->text);
    for (const Finding& finding : p.findings)
        if (!quiet) fmt::print(stderr, "grainray: warning: {}\n", finding.text);
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
