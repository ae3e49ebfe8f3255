// A time step. Impl::step() is the table of contents of the whole program.
#include "boundary/build.hpp"
#include "device_memory.hpp"
#include "observe.hpp"

#include <algorithm>
#include <cmath>

namespace grainray {

void Simulation::Impl::step() {
    {
        Timed timed(profile.contacts);
        stage.contacts(state, law, constants);
    }
    {
        Timed timed(profile.boundary);
        stage.walls(state, law, constants);
        if (state.facets.count()) stage.facets(state, law, constants, 0, FacetTarget::wrench);
    }
    {
        Timed timed(profile.dynamics);
        ++state.age.steps;
        stage.integrate(state, constants, margin_rule.trigger);
        state.age.outdated = state.flags.data()[0] != ~0u || state.age.steps >= state.age.limit;
    }
    ++step_number;
    if (planes_move) place_planes();
    if (meshes_move) place_meshes();
}

std::uint32_t Simulation::Impl::fused_steps(std::uint64_t most) {
    Timed timed(profile.fused);
    // First as many as lists usually last, then a few at a time: steps launched past the end of a list cost a little.
    const double expected = usual_life > state.age.steps ? usual_life - state.age.steps : std::max(2.0, usual_life / 8);
    const auto steps = static_cast<std::uint32_t>(
        std::min({most, std::uint64_t{state.age.limit - state.age.steps}, std::uint64_t{64}, static_cast<std::uint64_t>(std::ceil(expected))}));
    if (planes_move) place_planes(steps);
    if (meshes_move) place_meshes(steps);
    const std::uint32_t done = stage.fused(state, law, constants, margin_rule.trigger, steps);
    step_number += done;
    if (planes_move) place_planes();
    if (meshes_move) place_meshes();
    return done;
}

void Simulation::Impl::run(std::uint64_t steps) {
    for (std::uint64_t end = step_number + steps; step_number < end;) {
        if (state.age.outdated) update_lists();
        if (stage.fused) fused_steps(end - step_number);
        else step();
    }
    steps_since_start += steps;
    particle_steps += steps * state.size();
}

/// Without a particle only time goes on.
void Simulation::Impl::skip(std::uint64_t steps) {
    step_number += steps;
    if (planes_move) place_planes();
    if (meshes_move) place_meshes();
}

void Simulation::Impl::tune_interval() {
    IntervalTuner::Life life{static_cast<double>(state.age.steps), static_cast<double>(state.age.limit), static_cast<double>(state.grains.partners.size()),
                             static_cast<double>(state.size()), state.age.widening, profile.neighbors - list_start.neighbors,
                             profile.contacts + profile.fused - list_start.contacts - list_start.fused, profile.boundary - list_start.boundary};
    if (life.early() && tuner.looks()) {
        Timed timed(profile.neighbors);
        const Leaver leaver = stage.list_end(state, constants);
        if (leaver.margin < 0.999f * state.age.widest) {  // else no knob would have widened it
            life.leaver_margin = margin_rule.trigger * leaver.margin / leaver.radius;
            life.leaver_speed = leaver.speed / leaver.radius;
        }
    }
    if (const View<const std::uint8_t> touched = state.grains.touched.view(); touched.size)
        life.touching = static_cast<double>(std::count(touched.begin(), touched.end(), std::uint8_t{1})) / static_cast<double>(touched.size);
    tuner.finished(life);
    margin_rule.interval = static_cast<float>(tuner.interval());
    margin_rule.least = static_cast<float>(tuner.skin());
    usual_life += 0.3 * (state.age.steps - usual_life);
    list_start = profile;
}

void Simulation::Impl::prepare() {
    place_planes();
    place_meshes();
    if (state.size()) threads.run([&] { make_lists(); });
}

void Simulation::Impl::update_lists() {
    tune_interval();
    Timed timed(profile.neighbors);
    stage.retire(state, old_grains);
    std::swap(state.walls, old_walls);
    make_lists();
}

/// Sort, margins, search, then the histories of the old lists into the new ones.
void Simulation::Impl::make_lists() {
    stage.sort(state, old_grains, rows, old_index);
    old_grains.counts.release();  // only the order is by them
    find_pairs();
    stage.list_pairs(state, found, old_grains, old_index);
    stage.list_walls(state, constants, old_walls, old_index);
    if (state.facets.count()) stage.list_facets(state, constants, old_index);

    release_scratch();
    state.age.steps = 0;
    state.age.outdated = false;
    ++rebuilds;
}

/// On CUDA a list that would take more memory than is planned for is made again with smaller margins.
void Simulation::Impl::find_pairs() {
    const bool limited = options.device == Device::cuda;
    const auto planned = static_cast<std::size_t>(planned_entries * static_cast<double>(state.size()));
    for (MarginRule rule = margin_rule;;) {
        const Extents extents = stage.margins(state, constants, rule, spheres);
        const bool shorter_is_possible = limited && state.age.limit > IntervalTuner::shortest;
        search.set_most_entries(shorter_is_possible ? planned : ~std::size_t{0});
        const float* s = spheres.data();
        search.find(Points{s, s + 1, s + 2, 4, s + 3, 4, 0, state.particles.id.data(), state.size(), &extents}, found);
        const bool too_long = found.rows() == 0 || found.neighbors.size() > planned;
        if (!too_long || !shorter_is_possible) break;
        rule.interval = std::max<float>(IntervalTuner::shortest, 0.7f * static_cast<float>(state.age.limit));
        rule.least *= 0.7f;
        tuner.shorten(rule.interval, rule.least);
    }
    if (!limited) return;
    spheres.release();
    search.release();
}

void Simulation::Impl::release_scratch() {
    if (options.device != Device::cuda) return;
    old_grains.release();
    old_walls.release();
    old_index.release();
}

void Simulation::Impl::place_planes(std::uint32_t steps) {
    std::vector<PlaneNow> now;
    now.reserve(scene.planes.size() * steps);
    const Vec3d origin = state.particles.scale.origin;
    for (std::uint64_t step = step_number; step < step_number + steps; ++step)
        for (const Plane& plane : scene.planes) {
            const PlaneState p = plane_at(plane, time_of(step));
            const Motion& m = plane.motion;
            const double swing = length(m.oscillation_amplitude) * 6.2831853071795865 * m.oscillation_frequency;
            now.push_back({p.point - origin, p.normal, p.centre - origin, convert<float>(p.velocity), convert<float>(p.angular_velocity),
                           length(m.velocity) + std::fabs(swing), std::fabs(m.rotation_rate)});
        }
    state.plane_count = static_cast<std::uint32_t>(scene.planes.size());
    state.planes.assign(now);
}

void Simulation::Impl::place_meshes(std::uint32_t steps) { place_facets(scene, state.particles.scale, step_number, steps, state.facets); }

void Simulation::step() { run(1); }

void Simulation::run(std::uint64_t steps) {
    Impl& s = *impl_;
    for (const std::uint64_t end = s.step_number + steps; s.step_number < end;) {
        const std::uint64_t exchange = s.next_exchange(), batch = std::min(end, exchange) - s.step_number;
        if (s.state.size()) s.threads.run([&] { s.run(batch); });
        else s.skip(batch);
        if (s.step_number == exchange) s.threads.run([&] { s.exchange(); });
    }
}

std::size_t Simulation::size() const { return impl_->state.size(); }
std::uint64_t Simulation::step_count() const { return impl_->step_number; }
std::uint64_t Simulation::particle_steps() const { return impl_->particle_steps; }
double Simulation::time() const { return impl_->time(); }
double Simulation::dt() const { return impl_->scene.dt; }
Device Simulation::device() const { return impl_->options.device; }
const Profile& Simulation::profile() const { return impl_->profile; }
Profile& Simulation::profile() { return impl_->profile; }
const std::vector<LostParticle>& Simulation::lost() const { return impl_->lost; }
void Simulation::forget_lost() { impl_->lost.clear(); }

}  // namespace grainray
