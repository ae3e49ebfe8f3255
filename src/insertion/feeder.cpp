#include "insertion/feeder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainray {
namespace {

constexpr double most_fraction = 0.6;    // of the inlet's volume looks for a place at once; random insertion fills 0.4 at most
constexpr double bursts = 4;             // while a particle crosses the inlet: one leaves gaps in the stream, and fits in fewer
constexpr int most_failures = 10;        // in a row, after which an insertion ends
constexpr double rounding = 1e-9;        // of what is due: 0.1 / 1e-3 steps are 100

double steps_of(double time, double dt) { return std::nearbyint(std::min(time / dt, 9e18)); }

}  // namespace

std::uint64_t key_of(const std::string& name) {
    std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    return hash;
}

Feeder::Feeder(const Scene& scene, const ParticleStream& stream, std::uint64_t now)
    : scene_(scene), stream_(stream), inlet_(scene, stream), radius_(stream.size, scene.seed, "streams." + stream.name, place_of(scene, stream)),
      places_(scene.seed, "streams." + stream.name, scene::Stream::inlet), velocities_(scene.seed, "streams." + stream.name, scene::Stream::velocity) {
    if (!stream.rate.given()) throw InputError(place_of(scene, stream, "rate") + ": must be greater than 0");
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const Material& m) { return m.name == stream.material; });
    if (found == scene.materials.end()) throw InputError(fmt::format("{}: material '{}' is not defined", place_of(scene, stream, "material"), stream.material));
    material_ = static_cast<std::uint32_t>(found - scene.materials.begin());
    density_ = found->density;
    interval_ = static_cast<std::uint64_t>(std::max(1.0, steps_of(stream.interval > 0 ? stream.interval : inlet_.crossing_time() / bursts, scene.dt)));
    if (std::isfinite(stream.stop)) stop_ = static_cast<std::uint64_t>(steps_of(stream.stop, scene.dt));
    state_.key = key_of("streams." + stream.name);
    state_.since = std::max(now, static_cast<std::uint64_t>(steps_of(stream.start, scene.dt)));
}

double Feeder::elapsed(std::uint64_t step) const {
    const std::uint64_t end = std::min(step, stop_);
    return end > state_.since ? static_cast<double>(end - state_.since) * scene_.dt : 0;
}

bool Feeder::is_due(double elapsed, double mass) const {
    const double particles = static_cast<double>(state_.drawn + 1) * (1 - rounding), all = (state_.drawn_mass + mass) * (1 - rounding);
    const Amount &rate = stream_.rate, &total = stream_.total;
    return (rate.mass > 0 ? all <= rate.mass * elapsed : particles <= rate.particles * elapsed) &&
           (total.mass > 0 ? all <= total.mass : total.particles > 0 ? particles <= total.particles : true);
}

/// Nothing waits, and nothing will ever be due again.
bool Feeder::over(std::uint64_t step) const {
    if (state_.inserted < state_.drawn) return false;
    return step >= stop_ || !is_due(INFINITY, mass(state_.drawn));
}

std::uint64_t Feeder::next_step(std::uint64_t now) const {
    if (over(now)) return ~std::uint64_t{0};
    const std::uint64_t next = now < state_.since ? state_.since + interval_ : state_.since + ((now - state_.since) / interval_ + 1) * interval_;
    return now < stop_ ? std::min(next, std::max(stop_, state_.since + 1)) : next;
}

bool Feeder::draw(std::uint64_t step) {
    const double time = elapsed(step);
    for (double m = mass(state_.drawn); is_due(time, m); m = mass(state_.drawn)) {
        state_.drawn_mass += m;
        ++state_.drawn;
    }
    return state_.inserted < state_.drawn;
}

std::size_t Feeder::line_up(const InletRegion& region) {
    double volume = 0;
    for (const std::uint64_t number : state_.waiting) volume += sphere_volume(radius_(number));
    while (state_.tried < state_.drawn && (state_.waiting.empty() || volume < most_fraction * region.volume)) {
        volume += sphere_volume(radius_(state_.tried));
        state_.waiting.push_back(state_.tried++);
    }
    return state_.waiting.size();
}

/// Largest first, which fills a region better; places depend on the counter of attempts alone.
std::vector<Newcomer> Feeder::insert(const InletRegion& region, Vacancy& vacancy, const PositionScale& scale) {
    std::vector<std::pair<double, std::uint64_t>> order;
    for (const std::uint64_t number : state_.waiting) order.emplace_back(-radius_(number), number);
    std::sort(order.begin(), order.end());
    std::vector<Newcomer> placed;
    std::vector<std::uint64_t> waiting;
    int failures = 0;
    for (const auto& [negative_radius, number] : order) {
        const double radius = -negative_radius;
        Vec3l place;
        if (failures == most_failures || !find_place(region, vacancy, scale, radius, place)) {
            failures = std::min(failures + 1, most_failures);
            waiting.push_back(number);
            continue;
        }
        failures = 0;
        vacancy.add(place, radius);
        placed.push_back({place, radius, velocity(number), convert<float>(stream_.angular_velocity), static_cast<float>(mass(number)), material_});
        ++state_.inserted;
        state_.inserted_mass += mass(number);
    }
    std::sort(waiting.begin(), waiting.end());
    state_.waiting = std::move(waiting);
    return placed;
}

bool Feeder::find_place(const InletRegion& region, Vacancy& vacancy, const PositionScale& scale, double radius, Vec3l& place) {
    for (std::int64_t attempt = 0; attempt < stream_.attempts; ++attempt) {
        const auto centre = region.place(places_, state_.attempts++, radius);
        if (!centre) continue;
        place = scale.fixed(*centre);
        if (vacancy.has_room(place, radius)) return true;
    }
    return false;
}

Vec3f Feeder::velocity(std::uint64_t number) const {
    Vec3d v = stream_.velocity;
    for (int a = 0; a < 3; ++a)
        if (stream_.velocity_spread[a] > 0) v[a] += stream_.velocity_spread[a] * (2 * velocities_.uniform(3 * number + static_cast<std::uint64_t>(a)) - 1);
    return convert<float>(v);
}

double Feeder::mean_volume() const {
    constexpr std::uint64_t sample = 4096;
    double sum = 0;
    for (std::uint64_t n = 0; n < sample; ++n) sum += sphere_volume(radius_(n));
    return sum / static_cast<double>(sample);
}

StreamForecast Feeder::forecast(std::uint64_t last_step) const {
    const double mean_mass = mean_volume() * density_, time = elapsed(last_step);
    const auto mass_of = [&](const Amount& a) { return a.mass > 0 ? a.mass : a.particles * mean_mass; };
    StreamForecast f;
    f.interval_steps = interval_;
    f.crossing_time = inlet_.crossing_time();
    f.mass = mass_of(stream_.rate) * time;
    if (stream_.total.given()) f.mass = std::min(f.mass, mass_of(stream_.total));
    f.particles = f.mass / mean_mass;
    const double a_time = std::isfinite(f.crossing_time) ? std::max(f.crossing_time, stream_.interval) : stream_.interval;
    f.fraction = mass_of(stream_.rate) * a_time / density_ / inlet_.at(0)->volume;
    return f;
}

}  // namespace grainray
