#include "render/paint.hpp"

#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "render/palette.hpp"

namespace grainray::picture {

namespace {

using Values = std::vector<double>;

template <class T>
Values numbers(const std::vector<T>& field) { return Values(field.begin(), field.end()); }

Values magnitudes(const std::vector<Vec3f>& field) {
    Values values(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) values[i] = length(convert<double>(field[i]));
    return values;
}

enum class Look { from_zero, spread, kinds };

struct Field {
    const char *name, *needs, *title, *unit;
    Look look;
    Values (*values)(const Frame&);  ///< nullptr: measured against the ground
};

constexpr std::array fields{
    Field{"speed", "velocity", "speed", "m/s", Look::from_zero, [](const Frame& f) { return magnitudes(f.velocity); }},
    Field{"depth", "radius", "depth of the flow", "m", Look::from_zero, nullptr},
    Field{"radius", "radius", "radius", "m", Look::spread, [](const Frame& f) { return numbers(f.radius); }},
    Field{"velocity", "velocity", "speed", "m/s", Look::from_zero, [](const Frame& f) { return magnitudes(f.velocity); }},
    Field{"angular_velocity", "angular_velocity", "angular speed", "rad/s", Look::from_zero,
          [](const Frame& f) { return magnitudes(f.angular_velocity); }},
    Field{"id", "id", "", "", Look::kinds, [](const Frame& f) { return numbers(f.id); }},
    Field{"material", "material", "material", "", Look::kinds, [](const Frame& f) { return numbers(f.material); }},
    Field{"coordination", "coordination", "contacts", "", Look::from_zero, [](const Frame& f) { return numbers(f.coordination); }},
    Field{"contact_force", "contact_force", "contact force", "N", Look::from_zero,
          [](const Frame& f) { return numbers(f.contact_force); }},
    Field{"mass", "mass", "mass", "kg", Look::spread, [](const Frame& f) { return numbers(f.mass); }},
};

const Field& find_field(const std::string& name) {
    std::vector<std::string> known;
    for (const Field& field : fields) {
        if (field.name == name) return field;
        known.push_back(field.name);
    }
    throw InputError(fmt::format("render.color_by = \"{}\" is no field to colour by; choose one of {}", name, fmt::join(known, ", ")));
}

/// How far the top of each grain is above the ground below it: of the grains one sees, the depth of the flow.
Values depths(const Frame& frame, const HeightAboveGround& height) {
    Values values(frame.size());
    for (std::size_t i = 0; i < frame.size(); ++i) values[i] = height(frame.position[i]) + frame.radius[i];
    return values;
}

/// The values of the spheres that are drawn.
Values sphere_values(const Frame& frame, const Values& all, const Field& field, const Subject& subject) {
    if (all.size() != frame.size())
        throw InputError(fmt::format("render.color_by = \"{}\" needs the field \"{}\", which the frame lacks: write it too, "
                                     "or colour by another", field.name, field.needs));
    Values values(subject.index.size());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = all[subject.index[k]];
    return values;
}

/// Both ends as given; a free end is moved out to the next tick mark, an empty range made a small one.
Scale rounded(double low, double high, bool low_given, bool high_given) {
    if (!(low < high)) {
        const double end = high_given ? high : low, room = end == 0 ? 1 : 0.05 * std::abs(end);
        if (!high_given) high = end + room;
        if (!low_given && end != 0) low = end - room;
    }
    const double step = tick_step(low, high);
    if (!low_given) low = std::floor(low / step + 1e-6) * step;
    if (!high_given) high = std::ceil(high / step - 1e-6) * step;
    return {low, high};
}

Scale choose_scale(const Values& values, const Field& field, const RenderSettings& settings) {
    const auto [minimum, maximum] = std::pair{settings.color_minimum, settings.color_maximum};
    if (!std::isfinite(maximum.value_or(0) - minimum.value_or(0)))
        throw InputError(fmt::format("render.color_minimum = {} and render.color_maximum = {} must be finite numbers", minimum.value_or(0), maximum.value_or(0)));
    if (minimum && maximum && !(*minimum < *maximum))
        throw InputError(fmt::format("render.color_minimum = {} must be below render.color_maximum = {}", *minimum, *maximum));
    Values finite;
    for (const double v : values)
        if (std::isfinite(v)) finite.push_back(v);
    if (finite.empty()) finite.push_back(0);

    const bool zero = field.look == Look::from_zero;
    const double low = minimum.value_or(zero ? 0 : percentile(finite, 0.01));
    const double high = maximum.value_or(std::max(low, percentile(finite, zero ? 0.98 : 0.99)));
    Scale scale = rounded(low, high, minimum.has_value(), maximum.has_value());
    const double tolerance = 1e-6 * (scale.high - scale.low);
    for (const double v : finite) {
        scale.below = scale.below || v < scale.low - tolerance;
        scale.above = scale.above || v > scale.high + tolerance;
    }
    return scale;
}

Color quantity_color(double value, const Scale& scale) {
    if (!std::isfinite(value)) return {0.5f, 0.5f, 0.5f};
    return scale_color(static_cast<float>((value - scale.low) / (scale.high - scale.low)));
}

/// Materials in the scene's order with their names; ids mixed so that neighbours in a lattice differ.
std::size_t kind_of(double value, const Field& field) {
    const auto k = static_cast<std::uint32_t>(value);
    return std::string(field.name) == "id" ? hash(k) % kind_colors() : k;
}

std::vector<Kind> material_kinds(const Values& values, const Scene& scene) {
    std::vector<Kind> kinds;
    for (const double value : std::set<double>(values.begin(), values.end())) {
        const auto k = static_cast<std::size_t>(value);
        kinds.push_back({k < scene.materials.size() ? scene.materials[k].name : fmt::format("material {}", k), kind_color(k)});
    }
    return kinds;
}

}  // namespace

double tick_step(double low, double high) {
    const double least = (high - low) / 6 * (1 - 1e-9), power = std::pow(10, std::floor(std::log10(least)));
    return power * (least <= power ? 1 : least <= 2 * power ? 2 : least <= 5 * power ? 5 : 10);
}

Scale joined(const Scale& a, const Scale& b) { return {std::min(a.low, b.low), std::max(a.high, b.high), a.below || b.below, a.above || b.above}; }

Paint make_paint(const Frame& frame, const Scene& scene, const RenderSettings& settings, const Subject& subject, const Surroundings& surroundings,
                 const std::optional<Scale>& shared) {
    const Field& field = find_field(settings.color_by);
    const Values all = field.values ? field.values(frame) : depths(frame, HeightAboveGround(scene, surroundings, frame.time));
    const Values values = sphere_values(frame, all, field, subject);
    Paint paint{field.title, field.unit, {}, {}, {}};
    if (values.empty()) return paint;
    if (field.look != Look::kinds) paint.scale = shared ? *shared : choose_scale(values, field, settings);
    else if (std::string(field.name) == "material") paint.kinds = material_kinds(values, scene);

    paint.colors.reserve(values.size());
    for (const double value : values)
        paint.colors.push_back(linear_from_display(paint.scale ? quantity_color(value, *paint.scale) : kind_color(kind_of(value, field))));
    return paint;
}

}  // namespace grainray::picture
