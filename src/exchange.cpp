// Particles that come and go while the simulation runs. Both happen between two steps and end with new lists, into which
// the histories of all others go as at any rebuild: nothing of what stays is touched.
#include <algorithm>
#include <bit>
#include <numeric>

#include "boundary/build.hpp"
#include "mix.hpp"
#include "simulation_impl.hpp"

namespace grainray {
namespace {

constexpr double terrain_interval = 0.1;  // s between two looks for particles that left an open terrain

Exit exit_of(const Scene& scene, const Removal& removal, const Vec3d& origin) {
    switch (removal.region) {
        case RemovalRegion::half_space: return {Exit::Kind::half_space, removal.point - origin, removal.normal};
        case RemovalRegion::box: return {Exit::Kind::box, removal.box.lower - origin, removal.box.upper - origin};
        default: break;
    }
    if (!scene.domain.box) throw InputError("removals." + removal.name + ": there is no domain to be outside of");
    Exit exit{Exit::Kind::outside, scene.domain.box->lower - origin, scene.domain.box->upper - origin};
    for (int a = 0; a < 3; ++a)
        if (scene.domain.periodic[static_cast<std::size_t>(a)]) exit.a[a] = -INFINITY, exit.b[a] = INFINITY;
    return exit;
}

/// A row that is not there, for particles that are new.
void add_empty_row(ContactList& list) {
    std::uint64_t end = 0;
    detail::copy(Device::cpu, &end, list.offsets.device(), list.offsets.data() + list.offsets.size() - 1, sizeof end);
    list.offsets.append({end});
    if (list.counts.size()) list.counts.append({0});
}

void restore(std::vector<Feeder>& feeders, const Checkpoint& c) {
    for (Feeder& feeder : feeders)
        for (std::size_t k = 0; k < c.stream_key.size(); ++k) {
            if (c.stream_key[k] != feeder.state().key) continue;
            FeederState s{c.stream_key[k], c.stream_since[k], c.stream_drawn[k], c.stream_tried[k], c.stream_attempts[k], c.stream_inserted[k],
                          c.stream_drawn_mass[k], c.stream_inserted_mass[k], {}};
            for (std::size_t w = 0; w < c.waiting_number.size(); ++w)
                if (c.waiting_stream[w] == k) s.waiting.push_back(c.waiting_number[w]);
            feeder.restore(s);
        }
}

}  // namespace

void Simulation::Impl::begin_exchanges(const Checkpoint* c) {
    const Vec3d origin = state.particles.scale.origin;
    for (const ParticleStream& stream : scene.streams) {
        if (grainray::largest_radius(stream.size) > 1.0001 * std::ldexp(state.particles.scale.unit, 27))
            throw InputError(place_of(scene, stream) + ": its largest particles are larger than the checkpoint's positions allow for; start a new run");
        feeders.emplace_back(scene, stream, step_number);
    }
    for (std::uint32_t k = 0; k < scene.removals.size(); ++k) {
        const Removal& removal = scene.removals[k];
        exits.push_back({exit_of(scene, removal, origin), static_cast<std::uint64_t>(std::max<std::int64_t>(1, removal.steps)), k, key_of("removals." + removal.name)});
    }
    if (const auto terrain = open_terrain(scene, state.facets))
        exits.push_back({{Exit::Kind::left, terrain->lower, terrain->upper}, std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(terrain_interval / scene.dt))),
                         LostParticle::left_terrain, key_of("terrain")});
    if (!c) return;
    placed = c->placed;
    next_id = c->next_id;
    restore(feeders, *c);
    for (ExitRun& run : exits)
        for (std::size_t k = 0; k < c->removal_key.size(); ++k)
            if (c->removal_key[k] == run.key) run.particles = c->removal_particles[k], run.mass = c->removal_mass[k];
}

void Simulation::Impl::keep_exchanges(Checkpoint& c) const {
    c.placed = placed;
    c.next_id = next_id;
    for (std::uint32_t k = 0; k < feeders.size(); ++k) {
        const FeederState& s = feeders[k].state();
        c.stream_key.push_back(s.key);
        c.stream_since.push_back(s.since);
        c.stream_drawn.push_back(s.drawn);
        c.stream_tried.push_back(s.tried);
        c.stream_attempts.push_back(s.attempts);
        c.stream_inserted.push_back(s.inserted);
        c.stream_drawn_mass.push_back(s.drawn_mass);
        c.stream_inserted_mass.push_back(s.inserted_mass);
        c.waiting_stream.insert(c.waiting_stream.end(), s.waiting.size(), k);
        c.waiting_number.insert(c.waiting_number.end(), s.waiting.begin(), s.waiting.end());
    }
    for (const ExitRun& run : exits) {
        c.removal_key.push_back(run.key);
        c.removal_particles.push_back(run.particles);
        c.removal_mass.push_back(run.mass);
    }
}

std::uint64_t Simulation::Impl::hash_exchanges() const {
    std::uint64_t sum = 0;
    for (const Feeder& feeder : feeders) {
        const FeederState& s = feeder.state();
        std::uint64_t h = mix(5, s.key);
        for (const std::uint64_t value : {next_id, s.since, s.drawn, s.tried, s.attempts, s.inserted, std::bit_cast<std::uint64_t>(s.drawn_mass)}) h = mix(h, value);
        for (const std::uint64_t number : s.waiting) h = mix(h, number);
        sum += h;
    }
    return sum;
}

std::uint64_t Simulation::Impl::next_exchange() const {
    std::uint64_t next = ~std::uint64_t{0};
    for (const Feeder& feeder : feeders) next = std::min(next, feeder.next_step(step_number));
    for (const ExitRun& run : exits) next = std::min(next, (step_number / run.every + 1) * run.every);
    return next;
}

/// Those that go go first, and make room.
void Simulation::Impl::exchange() {
    Timed timed(profile.insertion);
    const std::vector<Departure> gone = depart();
    const std::vector<Newcomer> come = arrive();
    if (gone.empty() && come.empty()) return;
    if (gone.empty()) {
        open_lists();
        std::vector<std::uint32_t> same(state.size());
        std::iota(same.begin(), same.end(), 0u);
        rows.assign(same);
    }
    append(come);
    close_lists();
}

std::vector<Departure> Simulation::Impl::depart() {
    std::vector<Exit> due;
    std::vector<ExitRun*> runs;
    for (ExitRun& run : exits) {
        if (step_number % run.every != 0) continue;
        due.push_back(run.exit);
        runs.push_back(&run);
    }
    if (due.empty() || state.size() == 0 || stage.count_taken(state, due) == 0) return {};
    open_lists();
    std::vector<Departure> gone = stage.take_out(state, due, rows);
    std::sort(gone.begin(), gone.end(), [](const Departure& a, const Departure& b) { return a.id < b.id; });
    const PositionScale& scale = state.particles.scale;
    for (const Departure& d : gone) {
        ExitRun& run = *runs[d.exit];
        ++run.particles;
        run.mass += d.mass;
        lost.push_back({step_number, time(), d.id, scale.world(d.position), d.velocity, static_cast<float>(d.radius * scale.unit), run.removal});
    }
    return gone;
}

std::vector<Newcomer> Simulation::Impl::arrive() {
    std::vector<Newcomer> all;
    const PositionScale& scale = state.particles.scale;
    for (Feeder& feeder : feeders) {
        if (feeder.next_step(step_number - 1) != step_number || !feeder.draw(step_number)) continue;
        const auto region = feeder.inlet().at(time());
        std::vector<Resident> there;
        if (state.size()) there = stage.residents(state, {region->bounds.lower - scale.origin, region->bounds.upper - scale.origin});
        for (const Newcomer& n : all) there.push_back({n.position, static_cast<std::int32_t>(std::llrint(n.radius / scale.unit))});
        obstacles.update(time());
        Vacancy vacancy(*region, there, obstacles, state, largest_radius, feeder.line_up(*region));
        const auto come = feeder.insert(*region, vacancy, scale);
        all.insert(all.end(), come.begin(), come.end());
    }
    return all;
}

/// From now on the lists are old ones: they have a row for every particle there was, and an empty one. Which is whose, `rows`
/// is told by what follows.
void Simulation::Impl::open_lists() {
    if (state.size()) {
        stage.retire(state, old_grains);
        std::swap(state.walls, old_walls);
    }
    add_empty_row(old_grains);
    add_empty_row(old_walls);
    if (state.facets.list.row_of.size()) state.facets.list.row_of.append({~0u});
}

void Simulation::Impl::append(const std::vector<Newcomer>& come) {
    if (next_id + come.size() > std::uint64_t{1} << 32) throw SimulationError("4294967296 particles have come; no more can be numbered");
    const std::size_t n = come.size();
    const double unit = state.particles.scale.unit;
    std::vector<Near> near(n);
    std::vector<Far> far(n);
    std::vector<Body> body(n);
    std::vector<std::uint32_t> id(n);
    for (std::size_t k = 0; k < n; ++k) {
        const Newcomer& p = come[k];
        near[k] = {near_of(p.position.x), near_of(p.position.y), near_of(p.position.z), static_cast<std::int32_t>(std::llrint(p.radius / unit))};
        far[k] = far_of(p.position);
        body[k] = {p.velocity, p.mass, p.spin, p.material};
        id[k] = static_cast<std::uint32_t>(next_id++);
    }
    Particles& all = state.particles;
    all.near.append(near);
    all.far.append(far);
    all.body.append(body);
    all.remainder.append(std::vector<Vec3f>(n));
    all.id.append(id);
    rows.append(std::vector<std::uint32_t>(n, static_cast<std::uint32_t>(old_grains.offsets.size() - 2)));
}

void Simulation::Impl::close_lists() {
    if (!stage.fused) state.wrench.resize_discard(state.size());
    state.wrench.clear_bytes();
    if (state.size()) {
        resize_blocks();
        make_lists();
    } else {  // no row is anybody's
        old_grains.release();
        old_grains.offsets.assign(std::vector<std::uint64_t>{0});
        old_walls.offsets.assign(std::vector<std::uint64_t>{0});
        state.facets.list = FacetList(options.device);
    }
    rows.resize_discard(0);
    list_start = profile;
}

std::vector<StreamReport> Simulation::streams() const {
    std::vector<StreamReport> reports;
    for (const Feeder& feeder : impl_->feeders) {
        const FeederState& s = feeder.state();
        reports.push_back({feeder.stream().name, s.inserted, s.drawn - s.inserted, s.inserted_mass, s.drawn > s.inserted ? s.drawn_mass - s.inserted_mass : 0});
    }
    return reports;
}

std::vector<RemovalReport> Simulation::removals() const {
    std::vector<RemovalReport> reports;
    for (const ExitRun& run : impl_->exits) {
        const bool of_terrain = run.removal == LostParticle::left_terrain;
        reports.push_back({of_terrain ? "terrain" : impl_->scene.removals[run.removal].name, of_terrain, run.particles, run.mass});
    }
    return reports;
}

}  // namespace grainray
