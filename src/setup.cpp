// Making a simulation from a scene or a checkpoint.
#include <algorithm>
#include <numeric>

#include "boundary/build.hpp"
#include "contacts/laws.hpp"
#include "exec/exec.hpp"
#include "observe.hpp"

namespace grainray {

ContactLaw contact_law(const std::string& name) {
    std::string known;
    for (const auto& [law, law_name] : law_names) {
        if (name == law_name) return law;
        known += (known.empty() ? "" : ", ") + std::string(law_name);
    }
    throw InputError("contact law '" + name + "' is not known; known: " + known);
}

const Stages& stages(Device device) {
#ifdef GRAINRAY_HAS_CUDA
    if (device == Device::cuda) return cuda::stage_table;
#endif
    if (device == Device::cuda) throw InputError("device 'cuda' asked for, but " + cuda_status());
    return cpu::stage_table;
}

namespace {

constexpr double pi = 3.14159265358979323846;

PairParameters kernel_parameters(const MaterialPair& p) {
    return {static_cast<float>(p.normal_stiffness), static_cast<float>(p.tangential_stiffness), static_cast<float>(p.friction),
            static_cast<float>(2 * p.normal_damping * std::sqrt(p.normal_stiffness)),
            static_cast<float>(2 * p.tangential_damping * std::sqrt(p.tangential_stiffness))};
}

std::size_t material_index(const Scene& scene, const std::string& name) {
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (scene.materials[m].name == name) return m;
    throw InputError("material '" + name + "' is not defined in the scene");
}

/// 1 where there is none.
double largest_of(const Scene& scene, const InitialState& s) {
    double largest = s.radii.empty() ? 0 : *std::max_element(s.radii.begin(), s.radii.end());
    for (const ParticleStream& stream : scene.streams) largest = std::max(largest, largest_radius(stream.size));
    return largest > 0 ? largest : 1;
}

/// Fixed-point zero: the middle of the particles, on a coarse lattice of units so that it is exact in double.
PositionScale scale_for(const Scene& scene, const InitialState& s) {
    PositionScale scale = PositionScale::for_radius(largest_of(scene, s), {});
    std::vector<Vec3d> places = s.positions;
    for (const ParticleStream& stream : scene.streams) {
        const Box inlet = Inlet(scene, stream).at(0)->bounds;
        places.insert(places.end(), {inlet.lower, inlet.upper});
    }
    Vec3d lower = places.empty() ? Vec3d{} : places[0], upper = lower;
    for (const Vec3d& p : places)
        for (int a = 0; a < 3; ++a) {
            lower[a] = std::min(lower[a], p[a]);
            upper[a] = std::max(upper[a], p[a]);
        }
    const double lattice = scale.unit * (1 << 30);
    for (int a = 0; a < 3; ++a) {
        if (scene.domain.periodic[a]) scale.origin[a] = scene.domain.box->lower[a];
        else scale.origin[a] = std::round(0.5 * (lower[a] + upper[a]) / lattice) * lattice;
    }
    return scale;
}

SearchOptions search_options(const Scene& scene, const SimulationOptions& options, const State& state, std::uint32_t block) {
    SearchOptions o;
    o.backend = options.backend != "auto" ? options.backend : scene.search.backend;
    if (o.backend == "rays" && scene.search.rays.variant == "published") o.backend = "rays-published";
    o.kind = ListKind::blocked;
    o.block = block;
    o.ascending = false;
    o.local_order = true;  // the sort stage sees to it
    for (int a = 0; a < 3; ++a) o.period[a] = static_cast<float>(static_cast<double>(state.period[a]) * state.particles.scale.unit);
    return o;
}

/// Blocks: one on one thread; a few a thread otherwise, so that work spreads and few pairs are computed twice.
std::uint32_t block_size(Device device, std::size_t n, int threads) {
    if (device == Device::cuda) return 1;
    const std::size_t blocks = threads == 1 ? 1 : 4 * static_cast<std::size_t>(threads);
    return static_cast<std::uint32_t>(std::max<std::size_t>((n + blocks - 1) / blocks, 512));
}

}  // namespace

void Simulation::Impl::resize_blocks() {
    state.block = block_size(options.device, state.size(), threads.count());
    search.set_block(state.block);
}

namespace {

/// Fixed-point position of particle i; an error names it.
Vec3l fixed_position(const PositionScale& scale, const Vec3d& x, std::size_t i) {
    try {
        return scale.fixed(x);
    } catch (const InputError& e) {
        throw InputError("particle " + std::to_string(i) + ": " + e.what());
    }
}

void set_period(const Scene& scene, State& state) {
    for (int a = 0; a < 3; ++a) {
        if (!scene.domain.periodic[a]) continue;
        const double width = scene.domain.box->extent()[a];
        state.period[a] = std::llrint(width / state.particles.scale.unit);
        const double largest = 4.0 * (std::int64_t{1} << 27);  // twice the sum of the two largest radii, at least
        if (static_cast<double>(state.period[a]) < largest)
            throw InputError("domain: the periodic box is " + std::to_string(width) + " m along axis " + std::string(1, "xyz"[a]) +
                             "; it must be at least " + std::to_string(largest * state.particles.scale.unit) +
                             " m for particles of this size, so that a particle cannot meet itself");
    }
    state.period_lower = {};
}

}  // namespace

Simulation::Impl::Impl(const Scene& s, const SimulationOptions& o, const PositionScale& scale, const InitialState& sizes, double largest_ever)
    : scene(s), options(o), threads(o.threads), state(o.device), search(o.device), stage(stages(o.device)),
      law(contact_law(s.contact.law)), old_grains(o.device), old_walls(o.device), found(o.device), old_index(o.device), rows(o.device),
      spheres(o.device) {
    const std::size_t n = sizes.size(), nm = scene.materials.size();
    state.particles.scale = scale;
    state.materials = static_cast<std::uint32_t>(nm);
    state.block = block_size(options.device, n, threads.count());
    set_period(scene, state);
    search = NeighborSearch(options.device, search_options(scene, options, state, state.block));

    std::vector<PairParameters> grains, walls, facets;
    double stiffest = 1;
    for (std::size_t a = 0; a < nm; ++a) {
        for (std::size_t b = 0; b < nm; ++b) grains.push_back(kernel_parameters(contact_parameters(scene, a, b, false)));
        for (const Plane& plane : scene.planes)
            walls.push_back(kernel_parameters(contact_parameters(scene, a, material_index(scene, plane.material), true)));
        for (const Mesh& mesh : scene.meshes)
            facets.push_back(kernel_parameters(contact_parameters(scene, a, material_index(scene, mesh.material), true)));
        if (scene.terrain) facets.push_back(kernel_parameters(contact_parameters(scene, a, material_index(scene, scene.terrain->material), true)));
    }
    for (const auto* table : {&grains, &walls, &facets})
        for (const PairParameters& p : *table) stiffest = std::max({stiffest, double{p.kn}, double{p.kt}});
    state.grain_parameters.assign(grains);
    if (nm) state.only_parameters = grains[0];
    state.wall_parameters.assign(walls);
    state.facets.parameters.assign(facets);
    build_facets(scene, scale, state.facets);
    meshes_move = facets_move(scene);

    const bool some = n > 0 || !scene.streams.empty();
    largest_radius = some || largest_ever == 0 ? std::max(largest_ever, largest_of(scene, sizes)) : largest_ever;
    const double largest = largest_radius;
    smallest_radius = some ? INFINITY : 1;
    for (const double r : sizes.radii) smallest_radius = std::min(smallest_radius, r);
    for (const ParticleStream& stream : scene.streams) smallest_radius = std::min(smallest_radius, grainray::smallest_radius(stream.size));
    state.quanta = Quanta::for_scale(stiffest, largest);
    constants = {static_cast<float>(scene.dt), convert<float>(scene.gravity), static_cast<float>(scene.contact.mass_damping)};
    tuner = IntervalTuner(scene.search.interval, scene.search.skin);
    margin_rule.least = static_cast<float>(tuner.skin());
    margin_rule.interval = static_cast<float>(tuner.interval());
    margin_rule.most_units = static_cast<float>(largest / scale.unit);
    margin_rule.trigger = scene.search.trigger == Trigger::published ? 2.0f : 1.0f;

    for (ContactList* list : {&old_grains, &old_walls}) {
        list->offsets.resize_discard(n + 1);
        list->offsets.clear_bytes();
    }
    if (!stage.fused) state.wrench.resize_discard(n);
    state.wrench.clear_bytes();
    for (const Plane& plane : scene.planes) planes_move = planes_move || plane.motion.moves();
    const auto critical = critical_steps(scene, sizes);
    critical_dt = critical.empty() ? 0 : critical.front().critical_dt;
}

Simulation::Simulation(const Scene& scene, const InitialState& initial, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options, scale_for(scene, initial), initial)) {
    Particles& p = impl_->state.particles;
    const std::size_t n = initial.size();
    std::vector<Near> near(n);
    std::vector<Far> far(n);
    std::vector<Body> body(n);
    std::vector<std::uint32_t> id(n);
    std::iota(id.begin(), id.end(), 0u);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3l x = fixed_position(p.scale, initial.positions[i], i);
        const double r = initial.radii[i], density = scene.materials[initial.materials[i]].density;
        near[i] = {near_of(x.x), near_of(x.y), near_of(x.z), static_cast<std::int32_t>(std::llrint(r / p.scale.unit))};
        far[i] = far_of(x);
        body[i] = {convert<float>(initial.velocities.empty() ? Vec3d{} : initial.velocities[i]), static_cast<float>(4.0 / 3.0 * pi * r * r * r * density),
                   convert<float>(initial.angular_velocities.empty() ? Vec3d{} : initial.angular_velocities[i]), initial.materials[i]};
    }
    p.near.assign(near);
    p.far.assign(far);
    p.body.assign(body);
    p.remainder.assign(std::vector<Vec3f>(n));
    p.id.assign(id);
    impl_->placed = impl_->next_id = n;
    impl_->begin_exchanges();
    impl_->prepare();
}

namespace {

InitialState sizes_of(const Checkpoint& c) {
    InitialState s;
    for (std::size_t i = 0; i < c.id.size(); ++i) s.radii.push_back(c.radius_units[i] * c.unit);
    s.positions.resize(c.id.size());
    s.materials = c.material;
    return s;
}

/// Place in the checkpoint of ids: from a table, unless ids have become so far apart that it would outgrow the particles.
class Places {
public:
    explicit Places(const std::vector<std::uint32_t>& ascending) : ids_(ascending) {
        if (ids_.empty() || ids_.back() / 8 > ids_.size()) return;
        table_.resize(ids_.back() + std::size_t{1}, ~0u);
        for (std::size_t i = 0; i < ids_.size(); ++i) table_[ids_[i]] = static_cast<std::uint32_t>(i);
    }
    std::vector<std::uint32_t> operator()(std::vector<std::uint32_t> ids) const {
        for (auto& id : ids)
            id = !table_.empty() ? table_.at(id) : static_cast<std::uint32_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
        return ids;
    }

private:
    const std::vector<std::uint32_t>& ids_;
    std::vector<std::uint32_t> table_;
};

/// Histories sorted by (owner, partner), as one old list whose "old index" is the particle id.
struct OldLists {
    std::vector<std::uint64_t> offsets;
    std::vector<std::uint32_t> partners;
    std::vector<Vec3f> history;

    OldLists(std::size_t rows, const std::vector<std::uint32_t>& row, const std::vector<std::uint32_t>& partner, const std::vector<Vec3f>& h)
        : offsets(rows + 1, 0), partners(row.size()), history(row.size()) {
        for (const std::uint32_t r : row) ++offsets[r + 1];
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        auto next = offsets;
        for (std::size_t k = 0; k < row.size(); ++k) {
            partners[next[row[k]]] = partner[k];
            history[next[row[k]]++] = h[k];
        }
    }
    void store(ContactList& list) const {
        list.offsets.assign(offsets);
        list.partners.assign(partners);
        list.history.assign(history);
    }
};

}  // namespace

Simulation::Simulation(const Scene& scene, const Checkpoint& c, const SimulationOptions& options)
    : impl_(std::make_unique<Impl>(scene, options, PositionScale{c.unit, c.origin}, sizes_of(c), c.largest_radius)) {
    impl_->load(c);
}

void Simulation::Impl::load(const Checkpoint& c) {
    Particles& p = state.particles;
    const std::size_t n = c.id.size();
    std::vector<Near> near(n);
    std::vector<Far> far(n);
    std::vector<Body> body(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3l& x = c.position[i];
        near[i] = {near_of(x.x), near_of(x.y), near_of(x.z), c.radius_units[i]};
        far[i] = far_of(x);
        body[i] = {c.velocity[i], c.mass[i], c.angular_velocity[i], c.material[i]};
    }
    p.near.assign(near);
    p.far.assign(far);
    p.body.assign(body);
    p.remainder.assign(c.velocity_remainder);
    p.id.assign(c.id);
    const Places places(c.id);
    OldLists(n, places(c.contact_a), places(c.contact_b), c.contact_history).store(old_grains);
    OldLists(n, places(c.wall_particle), c.wall_plane, c.wall_history).store(old_walls);
    restore_facets(c, state.facets.list);
    if (!stage.fused) state.wrench.resize_discard(n);
    state.wrench.clear_bytes();
    step_number = c.step;
    begin_exchanges(&c);
    prepare();
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

}  // namespace grainray
