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
constexpr double lost_interval = 0.1;  // s between two looks for lost particles

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

/// Fixed-point zero: the middle of the particles, on a coarse lattice of units so that it is exact in double.
PositionScale scale_for(const Scene& scene, const InitialState& s) {
    const double largest = s.radii.empty() ? 1.0 : *std::max_element(s.radii.begin(), s.radii.end());
    PositionScale scale = PositionScale::for_radius(largest, {});
    Vec3d lower = s.size() ? s.positions[0] : Vec3d{}, upper = lower;
    for (const Vec3d& p : s.positions)
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
      law(contact_law(s.contact.law)), old_grains(o.device), old_walls(o.device), found(o.device), old_index(o.device),
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
    region = lost_region(scene, state.facets);
    if (region) lost_every = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(lost_interval / scene.dt)));

    largest_radius = sizes.radii.empty() && largest_ever == 0 ? 1 : largest_ever;
    for (const double r : sizes.radii) largest_radius = std::max(largest_radius, r);
    const double largest = largest_radius;
    if (n) smallest_radius = *std::min_element(sizes.radii.begin(), sizes.radii.end());
    state.quanta = Quanta::for_scale(stiffest, largest);
    constants = {static_cast<float>(scene.dt), convert<float>(scene.gravity), static_cast<float>(scene.contact.mass_damping)};
    tuner = IntervalTuner(scene.search.interval, scene.search.skin, options.device == Device::cpu ? 0.2 : 0.6);
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
    std::vector<std::uint32_t> place;  // id -> place in the checkpoint
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3l& x = c.position[i];
        near[i] = {near_of(x.x), near_of(x.y), near_of(x.z), c.radius_units[i]};
        far[i] = far_of(x);
        body[i] = {c.velocity[i], c.mass[i], c.angular_velocity[i], c.material[i]};
        if (c.id[i] >= place.size()) place.resize(c.id[i] + std::size_t{1}, ~0u);
        place[c.id[i]] = static_cast<std::uint32_t>(i);
    }
    p.near.assign(near);
    p.far.assign(far);
    p.body.assign(body);
    p.remainder.assign(c.velocity_remainder);
    p.id.assign(c.id);
    const auto places = [&](std::vector<std::uint32_t> ids) {
        for (auto& id : ids) id = place.at(id);
        return ids;
    };
    OldLists(n, places(c.contact_a), places(c.contact_b), c.contact_history).store(old_grains);
    OldLists(n, places(c.wall_particle), c.wall_plane, c.wall_history).store(old_walls);
    restore_facets(c, state.facets.list);
    if (!stage.fused) state.wrench.resize_discard(n);
    state.wrench.clear_bytes();
    step_number = c.step;
    prepare();
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

}  // namespace grainray
