// Stages: which particles are near an inlet, and particles taken out. Both are rare; a step knows nothing of them.
#include "insertion/exchange.hpp"

#include "exec/permute.hpp"
#include "stages.hpp"

namespace grainray::GRAINRAY_EXEC {
namespace {

struct Places {
    View<const Near> near;
    View<const Far> far;
    PositionScale scale;
    Vec3l period, period_lower;

    explicit Places(const State& s)
        : near(s.particles.near.view()), far(s.particles.far.view()), scale(s.particles.scale), period(s.period), period_lower(s.period_lower) {}
    GR_HD Vec3l position(std::size_t i) const { return into_box(join(near[i], far[i]), period, period_lower); }
    GR_HD double radius(std::size_t i) const { return near[i].radius * scale.unit; }
};

/// Does any image of a sphere reach into a box?
struct Reaches {
    Places places;
    Vec3d lower, upper;

    GR_HD bool operator()(std::size_t i) const {
        const Vec3d x = places.scale.local(places.position(i));
        const double r = places.radius(i);
        for (int a = 0; a < 3; ++a) {
            const double period = static_cast<double>(places.period[a]) * places.scale.unit;
            bool reaches = x[a] + r > lower[a] && x[a] - r < upper[a];
            if (period > 0)
                reaches = reaches || (x[a] + r + period > lower[a] && x[a] - r + period < upper[a]) || (x[a] + r - period > lower[a] && x[a] - r - period < upper[a]);
            if (!reaches) return false;
        }
        return true;
    }
};

/// Which exit takes a particle: its number, or ~0.
struct Takes {
    Places places;
    View<const Exit> exits;

    GR_HD std::uint32_t operator()(std::size_t i) const {
        const Vec3d x = places.scale.local(places.position(i));
        const double r = places.radius(i);
        for (std::uint32_t e = 0; e < exits.size; ++e)
            if (exits[e].takes(x, r)) return e;
        return ~0u;
    }
};

struct Sum {
    GR_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};

}  // namespace

std::vector<Resident> residents(const State& s, const Box& box) {
    const Reaches reaches{Places(s), box.lower, box.upper};
    const std::size_t n = s.size();
    Array<std::uint32_t> slots(device, n + 1);
    const auto slot = slots.view();
    for_each(n + 1, [=] GR_HD(std::size_t i) { slot[i] = i < n && reaches(i); });
    Array<Resident> found(device, exclusive_scan(slot));
    const auto out = found.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        if (slot[i] != slot[i + 1]) out[slot[i]] = {reaches.places.position(i), reaches.places.near[i].radius};
    });
    return found.to_host();
}

std::uint64_t count_taken(const State& s, const std::vector<Exit>& exits) {
    const Array<Exit> there(device, exits);
    const Takes takes{Places(s), there.view()};
    return reduce(s.size(), std::uint64_t{0}, [=] GR_HD(std::size_t i) { return std::uint64_t{takes(i) != ~0u}; }, Sum{});
}

std::vector<Departure> take_out(State& s, const std::vector<Exit>& exits, Array<std::uint32_t>& rows) {
    const Array<Exit> there(device, exits);
    const Takes takes{Places(s), there.view()};
    const std::size_t n = s.size();
    Array<std::uint32_t> slots(device, n + 1);
    const auto slot = slots.view();
    for_each(n + 1, [=] GR_HD(std::size_t i) { slot[i] = i < n && takes(i) == ~0u; });
    const std::size_t kept = exclusive_scan(slot);
    Array<std::uint32_t> from(device, kept);
    Array<Departure> gone(device, n - kept);
    const auto stays = from.view();
    const auto out = gone.view();
    const auto body = s.particles.body.view();
    const auto id = s.particles.id.view();
    for_each(n, [=] GR_HD(std::size_t i) {
        if (slot[i] != slot[i + 1]) stays[slot[i]] = static_cast<std::uint32_t>(i);
        else out[i - slot[i]] = {id[i], takes(i), takes.places.position(i), body[i].velocity, body[i].mass, takes.places.near[i].radius};
    });
    Particles& p = s.particles;
    permute(p.near, from);
    permute(p.far, from);
    permute(p.body, from);
    permute(p.remainder, from);
    permute(p.id, from);
    rows.swap(from);
    return gone.to_host();
}

}  // namespace grainray::GRAINRAY_EXEC
