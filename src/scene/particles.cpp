// [particles.NAME] -> ParticleGroup.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/read.hpp"

namespace grainray::scene {
namespace {

constexpr double most_particles = 2147483648.0;  // 2^31: ids are 32-bit

Lattice read_lattice(const Node& table) {
    Lattice lattice;
    read_fields(table, schema().lattice, lattice);
    const double total = static_cast<double>(lattice.count[0]) * static_cast<double>(lattice.count[1]) *
                         static_cast<double>(lattice.count[2]);
    if (total > most_particles)
        fail_key(table, "count", fmt::format("{:.3g} particles are too many; at most 2^31 = 2147483648", total));
    return lattice;
}

ParticleList read_list(const Node& table) {
    ParticleList list;
    read_fields(table, schema().list, list);
    const std::size_t n = list.positions.size();
    const auto check = [&](std::string_view key, std::size_t given, bool allowed) {
        if (given != n && !allowed)
            fail_key(table, key, fmt::format("has {} values for {} positions; give one a particle", given, n));
    };
    check("radii", list.radii.size(), list.radii.size() == 1);
    check("velocities", list.velocities.size(), list.velocities.empty());
    check("angular_velocities", list.angular_velocities.size(), list.angular_velocities.empty());
    return list;
}

RandomFill read_fill(const Node& table, const Scene& s) {
    FillRow row;
    read_fields(table, schema().fill, row);
    if (row.count && row.solid_fraction) fail_key(table, "solid_fraction", "give count or solid_fraction, not both");
    if (!row.count && !row.solid_fraction)
        fail_key(table, "count",
                 "a fill needs one of count and solid_fraction (a typical value is solid_fraction = 0.25)");
    check_box(table, row.lower, row.upper, s);
    return {{row.lower, row.upper}, row.count.value_or(0), row.solid_fraction.value_or(0)};
}

Release read_release(const Node& table, const Scene& s) {
    ReleaseRow row;
    read_fields(table, schema().release, row);
    if (row.spacing && row.count) fail_key(table, "count", "give spacing or count, not both");
    if (!row.spacing && !row.count) fail_key(table, "spacing", "a release needs one of spacing and count (a typical value is 0.74 m)");
    if (row.spacing && row.jitter >= *row.spacing) fail_key(table, "jitter", fmt::format("must be less than the spacing ({} m)", *row.spacing));
    if (!s.terrain) fail_key(table, "type", "a release lies on terrain; add a table [terrain] with the ground");
    if (row.polygon.has_value() != row.thickness.has_value())
        fail_key(table, row.polygon ? "polygon" : "thickness", fmt::format("a layer needs both outline and thickness; add '{}'", row.polygon ? "thickness" : "polygon"));
    if (!row.polygon && s.terrain->before_file.empty())
        fail_key(table, "type", "needs terrain.before, the surface before the slide, or polygon and thickness here");
    return {row.spacing.value_or(0), row.count.value_or(0), row.jitter, row.radius.value_or(0), row.polygon.value_or(""), row.thickness.value_or(0)};
}

/// Cut-offs that the scene does not give: three deviations, in the logarithm for a log-normal law.
void default_cutoffs(SizeRow& row) {
    if (row.law == SizeLaw::normal) {
        row.minimum = row.minimum.value_or(row.mean - 3 * row.deviation);
        row.maximum = row.maximum.value_or(row.mean + 3 * row.deviation);
    } else {
        const double variance = std::log1p(row.deviation * row.deviation / (row.mean * row.mean));
        const double median = row.mean * std::exp(-variance / 2), spread = std::exp(3 * std::sqrt(variance));
        row.minimum = row.minimum.value_or(median / spread);
        row.maximum = row.maximum.value_or(median * spread);
    }
}

}  // namespace

void check_box(const Node& table, const Vec3d& lower, const Vec3d& upper, const Scene& s) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(upper[axis] > lower[axis]))
            fail_key(table, "upper", fmt::format("must be greater than 'lower' along {} ({} m)", "xyz"[axis], lower[axis]));
        if (const auto& box = s.domain.box; box && (lower[axis] < box->lower[axis] || upper[axis] > box->upper[axis]))
            fail_key(table, lower[axis] < box->lower[axis] ? "lower" : "upper",
                     fmt::format("leaves the domain along {} ({} to {} m)", "xyz"[axis], box->lower[axis], box->upper[axis]));
    }
}

SizeDistribution read_size(const Node& table, SizeRow row) {
    read_fields(table, schema().size_laws[static_cast<std::size_t>(row.law)], row);
    if (row.law == SizeLaw::normal || row.law == SizeLaw::lognormal) {
        default_cutoffs(row);
        if (!(*row.minimum > 0))
            fail_key(table, "radius_minimum",
                     "the mean less 3 deviations is not positive; give the smallest radius to keep");
    }
    if (row.minimum && !(*row.maximum > *row.minimum))
        fail_key(table, "radius_maximum", fmt::format("must be greater than radius_minimum ({} m)", *row.minimum));
    if (row.law == SizeLaw::table) {
        if (row.radii.empty()) fail_key(table, "radii", "must name at least one radius");
        if (row.weights.empty()) row.weights.assign(row.radii.size(), 1.0);
        if (row.weights.size() != row.radii.size())
            fail_key(
                table, "weights",
                fmt::format("has {} values for {} radii; give one a radius", row.weights.size(), row.radii.size()));
        if (*std::max_element(row.weights.begin(), row.weights.end()) <= 0)
            fail_key(table, "weights", "at least one must be greater than 0");
    }
    return {row.law,   row.radius, row.minimum.value_or(0), row.maximum.value_or(0), row.mean, row.deviation,
            row.radii, row.weights};
}

namespace {

/// Throws for a key that this type (and size law) has no use for.
void check_group_keys(const Node& table, const PlacementRow& placement, const SizeRow& size) {
    std::vector<std::string_view> known;
    append_keys(known, schema().placement);
    append_keys(known, schema().group);
    std::string of =
        fmt::format("type = \"{}\"", schema().placement.fields[0].choices[static_cast<std::size_t>(placement.type)]);
    switch (placement.type) {
        case Placement::lattice: append_keys(known, schema().lattice); break;
        case Placement::list: append_keys(known, schema().list); break;
        case Placement::file: append_keys(known, schema().file); break;
        case Placement::fill: append_keys(known, schema().fill); break;
        case Placement::release: append_keys(known, schema().release); break;
    }
    if (placement.type == Placement::lattice || placement.type == Placement::fill) {
        append_keys(known, schema().size);
        append_keys(known, schema().size_laws[static_cast<std::size_t>(size.law)]);
        of += fmt::format(", size = \"{}\"", schema().size.fields[0].choices[static_cast<std::size_t>(size.law)]);
    }
    check_keys(table, std::move(known), of);
}

}  // namespace

ParticleGroup read_group(const Node& table, const std::string& name, const Scene& s) {
    ParticleGroup group;
    PlacementRow placement;
    SizeRow size;
    group.name = name;
    read_fields(table, schema().placement, placement);
    const bool sized = placement.type == Placement::lattice || placement.type == Placement::fill;
    if (sized) read_fields(table, schema().size, size);
    check_group_keys(table, placement, size);
    read_fields(table, schema().group, group);
    check_material(table.child("material"), group.material, s);
    switch (placement.type) {
        case Placement::lattice: group.placement = read_lattice(table); break;
        case Placement::list: group.placement = read_list(table); break;
        case Placement::fill: group.placement = read_fill(table, s); break;
        case Placement::release: group.placement = read_release(table, s); break;
        case Placement::file: {
            FileRow row;
            read_fields(table, schema().file, row);
            group.placement = ParticleFile{row.path};
        }
    }
    if (sized) group.size = read_size(table, size);
    return group;
}

}  // namespace grainray::scene
