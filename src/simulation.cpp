// A time step. Impl::step() is the table of contents of the whole program.
#include "simulation_impl.hpp"

#include <algorithm>
#include <chrono>

#include "boundary/build.hpp"
#include "observe.hpp"

namespace grainray {
namespace {

/// Adds the time until its end of scope to one entry of the profile.
class Timed {
public:
    explicit Timed(double& seconds) : seconds_(seconds), start_(clock::now()) {}
    ~Timed() { seconds_ += std::chrono::duration<double>(clock::now() - start_).count(); }

private:
    using clock = std::chrono::steady_clock;
    double& seconds_;
    clock::time_point start_;
};

}  // namespace

void Simulation::Impl::step() {
    if (state.age.outdated) {
        tune_interval();
        Timed timed(profile.neighbors);
        update_lists();
    }
    {
        Timed timed(profile.contacts);
        stage.contacts(state, law, constants);
    }
    {
        Timed timed(profile.boundary);
        stage.walls(state, law, constants);
        if (state.facets.count()) stage.facets(state, law, constants, 0);
    }
    {
        Timed timed(profile.dynamics);
        ++state.age.steps;
        stage.integrate(state, constants, margin_rule.trigger);
        std::uint32_t flag[2];
        detail::copy(Device::cpu, flag, options.device, state.flags.data(), sizeof flag);
        state.age.outdated = flag[0] != ~0u || state.age.steps >= state.age.limit;
    }
    ++step_number;
    ++steps_since_start;
    if (planes_move) place_planes();
    if (meshes_move) place_facets(scene, state.particles.scale, step_number, 1, state.facets);
}

void Simulation::Impl::tune_interval() {
    tuner.finished(state.age.steps, state.grains.partners.size(), profile.neighbors - list_start.neighbors,
                   profile.contacts - list_start.contacts);
    margin_rule.interval = static_cast<float>(tuner.interval());
    list_start = profile;
}

void Simulation::Impl::prepare() {
    place_planes();
    place_facets(scene, state.particles.scale, step_number, 1, state.facets);
    if (state.size()) threads.run([&] { update_lists(); });
}

/// Sort, margins, search, then the histories of the old lists into the new ones.
void Simulation::Impl::update_lists() {
    stage.sort(state, old_index);
    stage.margins(state, constants, margin_rule, spheres);

    const float* s = spheres.data();
    std::swap(state.grains, old_grains);
    NeighborList found(options.device);  // borrows the memory of the list before last
    found.offsets.swap(state.grains.offsets);
    found.neighbors.swap(state.grains.partners);
    search.find(Points{s, s + 1, s + 2, 4, s + 3, 4, 0, state.particles.id.data(), state.size()}, found);
    found.offsets.swap(state.grains.offsets);
    found.neighbors.swap(state.grains.partners);
    state.grains.history.resize_discard_slack(state.grains.partners.size());
    stage.carry_pairs(old_grains, old_index, state.grains);

    std::swap(state.walls, old_walls);
    stage.wall_candidates(state, constants, state.walls);
    stage.carry_walls(old_walls, old_index, state.walls);
    if (state.facets.count()) {
        stage.facet_candidates(state, constants);
        stage.carry_facets(state, old_index);
    }

    detail::copy(options.device, state.flags.data(), Device::cpu, std::array{~0u, ~0u}.data(), 2 * sizeof(std::uint32_t));
    state.age.steps = 0;
    state.age.outdated = false;
    ++rebuilds;
}

void Simulation::Impl::place_planes() {
    std::vector<PlaneNow> now;
    now.reserve(scene.planes.size());
    const Vec3d origin = state.particles.scale.origin;
    for (const Plane& plane : scene.planes) {
        const PlaneState p = plane_at(plane, time());
        const Motion& m = plane.motion;
        const double swing = length(m.oscillation_amplitude) * 6.2831853071795865 * m.oscillation_frequency;
        now.push_back({p.point - origin, p.normal, p.centre - origin, convert<float>(p.velocity), convert<float>(p.angular_velocity),
                       length(m.velocity) + std::fabs(swing), std::fabs(m.rotation_rate)});
    }
    if (state.planes.size() != now.size()) state.planes.resize_discard(now.size());
    if (!now.empty()) detail::copy(options.device, state.planes.data(), Device::cpu, now.data(), now.size() * sizeof(PlaneNow));
}

void Simulation::step() { run(1); }

void Simulation::run(std::uint64_t steps) {
    Impl& s = *impl_;
    while (steps > 0) {
        const std::uint64_t every = s.lost_every, batch = every ? std::min(steps, every - s.step_number % every) : steps;
        if (s.state.size() == 0) s.step_number += batch;
        else s.threads.run([&] {
            for (std::uint64_t k = 0; k < batch; ++k) s.step();
        });
        steps -= batch;
        if (every && s.step_number % every == 0) take_out_lost();
    }
}

/// Rare, so by the way of a restart, which is exact: what remains is the state, less the lost.
void Simulation::take_out_lost() {
    Impl& s = *impl_;
    if (s.state.size() == 0 || s.stage.count_lost(s.state, *s.region) == 0) return;
    const Checkpoint all = checkpoint();
    const PositionScale& scale = s.state.particles.scale;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < all.id.size(); ++i) {
        if (!s.region->lost(scale.local(all.position[i]), all.radius_units[i] * scale.unit)) kept.push_back(static_cast<std::uint32_t>(i));
        else s.lost.push_back({s.step_number, s.time(), all.id[i], scale.world(all.position[i]), all.velocity[i]});
    }
    s.load(only(all, kept));
}

std::size_t Simulation::size() const { return impl_->state.size(); }
std::uint64_t Simulation::step_count() const { return impl_->step_number; }
double Simulation::time() const { return impl_->time(); }
double Simulation::dt() const { return impl_->scene.dt; }
Device Simulation::device() const { return impl_->options.device; }
const Profile& Simulation::profile() const { return impl_->profile; }
Profile& Simulation::profile() { return impl_->profile; }
const std::vector<LostParticle>& Simulation::lost() const { return impl_->lost; }

}  // namespace grainray
