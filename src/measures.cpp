// Stages: what is measured of a state. One pass over particles and contacts each, on the device that holds them.
#include "measures.hpp"

#include "boundary/plane_contact.hpp"
#include "contacts/laws.hpp"
#include "exec/rows.hpp"
#include "mix.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

/// The particles and contacts of a state, as kernels see them.
struct Scenery {
    View<const Near> near;
    View<const Far> far;
    View<const Body> body;
    View<const Vec3f> remainder;
    View<const std::uint32_t> id;
    Rows rows;
    View<const std::uint64_t> wall_offsets;
    View<const std::uint32_t> wall_partners;
    View<const Vec3f> wall_history;
    View<const PlaneNow> planes;
    View<const PairParameters> grain_parameters, wall_parameters;
    PositionScale scale;
    Vec3l period, period_lower;
    std::uint32_t block, materials, plane_count;

    explicit Scenery(const State& s)
        : near(s.particles.near.view()), far(s.particles.far.view()), body(s.particles.body.view()), remainder(s.particles.remainder.view()),
          id(s.particles.id.view()), rows(s.grains), wall_offsets(s.walls.offsets.view()), wall_partners(s.walls.partners.view()),
          wall_history(s.walls.history.view()), planes(s.planes.view()), grain_parameters(s.grain_parameters.view()),
          wall_parameters(s.wall_parameters.view()), scale(s.particles.scale), period(s.period), period_lower(s.period_lower), block(s.block),
          materials(s.materials), plane_count(s.plane_count) {}

    GR_HD double radius(std::size_t i) const { return near[i].radius * scale.unit; }
    /// Fixed-point position, inside the periodic box.
    GR_HD Vec3l position(std::size_t i) const { return into_box(join(near[i], far[i]), period, period_lower); }

    /// visit(j, separation, k) for the touching pairs of row i, entry k; each pair comes once in all.
    template <class Visit>
    GR_HD void for_each_pair(std::size_t i, const Visit& visit) const {
        for (std::uint32_t k = 0, end = rows.size(i); k < end; ++k) {
            const std::uint32_t j = rows.partner(i, k);
            if (i / block != j / block && j > i) continue;  // stands in both rows
            const Separation apart = separation(near[i], far[i], near[j], far[j], period);
            if (apart.gap > 0) visit(j, apart, k);
        }
    }
    /// visit(plane, overlap, entry)
    template <class Visit>
    GR_HD void for_each_wall(std::size_t i, const Visit& visit) const {
        for (std::uint64_t e = wall_offsets[i]; e < wall_offsets[i + 1]; ++e) {
            const PlaneNow& plane = planes[wall_partners[e]];
            const double overlap = radius(i) - dot(plane.normal, scale.local(join(near[i], far[i])) - plane.point);
            if (overlap > 0) visit(wall_partners[e], overlap, e);
        }
    }
    GR_HD double overlap(std::size_t i, std::size_t j, const Separation& apart) const {
        const double x = apart.x, y = apart.y, z = apart.z, distance = sqrt(x * x + y * y + z * z) * scale.unit;
        return static_cast<double>(apart.gap) * scale.unit * scale.unit / (radius(i) + radius(j) + distance);
    }
};

struct JoinTotals {
    GR_HD Totals operator()(Totals a, const Totals& b) const {
        a.kinetic_translation += b.kinetic_translation;
        a.kinetic_rotation += b.kinetic_rotation;
        a.potential += b.potential;
        a.momentum += b.momentum;
        a.angular_momentum += b.angular_momentum;
        for (int k = 0; k < 3; ++k) {
            a.lower[k] = fmin(a.lower[k], b.lower[k]);
            a.upper[k] = fmax(a.upper[k], b.upper[k]);
        }
        a.max_speed = fmax(a.max_speed, b.max_speed);
        a.max_overlap_ratio = fmax(a.max_overlap_ratio, b.max_overlap_ratio);
        a.contact_sides += b.contact_sides;
        a.contacts += b.contacts;
        return a;
    }
};

struct Add {
    GR_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

/// Adds what the contacts of row i do to their particles.
template <class Law>
struct FieldsOf {
    Law law;
    Scenery view;
    View<std::uint32_t> coordination;
    View<std::int64_t> force;
    float inverse_quantum;

    GR_HD void add(std::size_t to, const Vec3f& f) const {
        atomic_add(&coordination[to], 1u);
        atomic_add(&force[to], quantize(length(f), inverse_quantum));
    }
    GR_HD void operator()(std::size_t i) const {
        const Body& a = view.body[i];
        view.for_each_pair(i, [&](std::uint32_t j, const Separation& apart, std::uint32_t k) {
            const Body& b = view.body[j];
            Vec3f h = view.rows.history(i, k);
            const PairForce f = pair_force(law, apart, view.near[i].radius, view.near[j].radius, a.velocity - b.velocity, a.spin, b.spin,
                                           0.5f * (a.mass + b.mass), view.grain_parameters[a.material * view.materials + b.material],
                                           static_cast<float>(view.scale.unit), h);
            add(i, f.force);
            add(j, f.force);
        });
        view.for_each_wall(i, [&](std::uint32_t q, double overlap, std::uint64_t e) {
            const PlaneNow& plane = view.planes[q];
            const Vec3d x = view.scale.local(join(view.near[i], view.far[i]));
            const Vec3f normal = convert<float>(plane.normal), arm = normal * static_cast<float>(view.radius(i) - 0.5 * overlap);
            const Vec3f wall_velocity = plane.velocity + cross(plane.spin, convert<float>(x - plane.centre) - arm);
            Vec3f h = view.wall_history[e];
            add(i, law(Contact{normal, static_cast<float>(overlap), a.velocity - cross(a.spin, arm) - wall_velocity, a.mass},
                       view.wall_parameters[a.material * view.plane_count + q], h));
        });
    }
};

}  // namespace

Totals totals(const State& s, const Vec3d& gravity) {
    const Scenery view(s);
    return reduce(s.size(), Totals{}, [=] GR_HD(std::size_t i) {
        const Body& b = view.body[i];
        const Vec3d x = view.scale.world(view.position(i)), v = convert<double>(b.velocity), w = convert<double>(b.spin);
        const double m = b.mass, r = view.radius(i), inertia = 0.4 * m * r * r;
        Totals t;
        t.kinetic_translation = 0.5 * m * dot(v, v);
        t.kinetic_rotation = 0.5 * inertia * dot(w, w);
        t.potential = -m * dot(gravity, x);
        t.momentum = v * m;
        t.angular_momentum = cross(x, v) * m + w * inertia;
        t.max_speed = sqrt(dot(v, v));
        t.lower = x - Vec3d{r, r, r};
        t.upper = x + Vec3d{r, r, r};
        view.for_each_pair(i, [&](std::uint32_t j, const Separation& apart, std::uint32_t) {
            t.max_overlap_ratio = fmax(t.max_overlap_ratio, view.overlap(i, j, apart) / fmin(r, view.radius(j)));
            t.contact_sides += 2;
            ++t.contacts;
        });
        view.for_each_wall(i, [&](std::uint32_t, double overlap, std::uint64_t) {
            t.max_overlap_ratio = fmax(t.max_overlap_ratio, overlap / r);
            t.contact_sides += 1;
            ++t.contacts;
        });
        return t;
    }, JoinTotals{});
}

double quantile_x(const State& s, double quantile) {
    const std::size_t n = s.size();
    const Scenery view(s);
    Array<std::uint64_t> keys(device, n), keys2(device);
    Array<std::uint32_t> order(device, n), order2(device);
    const auto key = keys.view();
    const auto index = order.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        key[i] = static_cast<std::uint64_t>(view.position(i).x) ^ std::uint64_t{1} << 63;
        index[i] = static_cast<std::uint32_t>(i);
    });
    sort_by_key(keys, order, keys2, order2, 64);
    const std::size_t place = static_cast<std::size_t>(quantile * static_cast<double>(n));
    std::uint64_t found = 0;
    detail::copy(Device::cpu, &found, device, keys.data() + (place < n ? place : n - 1), sizeof found);
    return s.particles.scale.world({static_cast<std::int64_t>(found ^ std::uint64_t{1} << 63), 0, 0}).x;
}

/// A sum over particles and contacts of hashes keyed by id: the order of storage does not matter.
std::uint64_t hash(const State& s) {
    const Scenery view(s);
    return reduce(s.size(), std::uint64_t{0}, [=] GR_HD(std::size_t i) {
        const std::uint32_t a = view.id[i];
        std::uint64_t h = mix(mix(1, a), view.position(i));
        h = mix(mix(mix(h, view.body[i].velocity), view.remainder[i]), view.body[i].spin);
        std::uint64_t sum = mix(h, static_cast<std::uint64_t>(view.near[i].radius));
        view.for_each_pair(i, [&](std::uint32_t j, const Separation&, std::uint32_t k) {
            const Vec3f history = view.rows.history(i, k);
            const std::uint32_t b = view.id[j];
            if (!(history == Vec3f{})) sum += a > b ? mix(mix(mix(2, a), b), history) : mix(mix(mix(2, b), a), -history);
        });
        view.for_each_wall(i, [&](std::uint32_t plane, double, std::uint64_t e) {
            if (!(view.wall_history[e] == Vec3f{})) sum += mix(mix(mix(3, a), plane), view.wall_history[e]);
        });
        return sum;
    }, Add{});
}

bool healthy(const State& s, const HealthLimits& limits) {
    const Scenery view(s);
    const std::uint64_t bad = reduce(s.size(), std::uint64_t{0}, [=] GR_HD(std::size_t i) {
        const Vec3d x = view.scale.world(view.position(i)), v = convert<double>(view.body[i].velocity), w = convert<double>(view.body[i].spin);
        const double spin = dot(w, w), r = view.radius(i);
        bool good = dot(v, v) <= limits.speed * limits.speed && spin - spin == 0;
        for (int k = 0; k < 3; ++k) good = good && x[k] >= limits.lower[k] && x[k] <= limits.upper[k];
        view.for_each_pair(i, [&](std::uint32_t j, const Separation& apart, std::uint32_t) {
            good = good && view.overlap(i, j, apart) <= limits.overlap * fmin(r, view.radius(j));
        });
        view.for_each_wall(i, [&](std::uint32_t, double overlap, std::uint64_t) { good = good && overlap <= limits.overlap * r; });
        return std::uint64_t{!good};
    }, Add{});
    return bad == 0;
}

void contact_fields(const State& s, ContactLaw law, ContactFields& out) {
    const std::size_t n = s.size();
    out.coordination.resize_discard(n);
    out.force.resize_discard(n);
    out.coordination.clear_bytes();
    out.force.clear_bytes();
    with_law(law, 0.0f, [&](auto still) {  // a step of 0: forces are as the histories stand
        for_each(n, FieldsOf<decltype(still)>{still, Scenery(s), out.coordination.view(), out.force.view(), static_cast<float>(1.0 / s.quanta.force)});
    });
}

}  // namespace grainray::GRAINRAY_EXEC
