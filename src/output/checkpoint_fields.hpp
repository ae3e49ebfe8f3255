// What a checkpoint holds, listed once: writing, reading and the checksum walk the same list.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

#include "grainray/output.hpp"

namespace grainray {

/// Raise this when the list below changes: older programs then say so instead of guessing.
constexpr std::uint32_t checkpoint_version = 3;
constexpr const char* checkpoint_format = "grainray checkpoint";

/// visit(name, value) for every number of a Checkpoint, const or not.
template <class C, class Visit>
void for_each_number(C& c, Visit visit) {
    visit("step", c.step);
    visit("time", c.time);
    visit("dt", c.dt);
    visit("unit", c.unit);
    visit("origin", c.origin);
    visit("largest_radius", c.largest_radius);
    visit("placed", c.placed);
    visit("next_id", c.next_id);
    visit("state_hash", c.state_hash);
}

/// visit(name, array, group) for every array; arrays of one group have one length.
template <class C, class Visit>
void for_each_array(C& c, Visit visit) {
    enum { particles, contacts, walls, facets, streams, waiting, removals };
    visit("id", c.id, particles);
    visit("material", c.material, particles);
    visit("position", c.position, particles);
    visit("radius", c.radius, particles);
    visit("mass", c.mass, particles);
    visit("radius_units", c.radius_units, particles);
    visit("velocity", c.velocity, particles);
    visit("velocity_remainder", c.velocity_remainder, particles);
    visit("angular_velocity", c.angular_velocity, particles);
    visit("contact_a", c.contact_a, contacts);
    visit("contact_b", c.contact_b, contacts);
    visit("contact_history", c.contact_history, contacts);
    visit("wall_particle", c.wall_particle, walls);
    visit("wall_plane", c.wall_plane, walls);
    visit("wall_history", c.wall_history, walls);
    visit("facet_particle", c.facet_particle, facets);
    visit("facet", c.facet, facets);
    visit("facet_side", c.facet_side, facets);
    visit("facet_history", c.facet_history, facets);
    visit("stream_key", c.stream_key, streams);
    visit("stream_since", c.stream_since, streams);
    visit("stream_drawn", c.stream_drawn, streams);
    visit("stream_tried", c.stream_tried, streams);
    visit("stream_attempts", c.stream_attempts, streams);
    visit("stream_inserted", c.stream_inserted, streams);
    visit("stream_drawn_mass", c.stream_drawn_mass, streams);
    visit("stream_inserted_mass", c.stream_inserted_mass, streams);
    visit("waiting_stream", c.waiting_stream, waiting);
    visit("waiting_number", c.waiting_number, waiting);
    visit("removal_key", c.removal_key, removals);
    visit("removal_particles", c.removal_particles, removals);
    visit("removal_mass", c.removal_mass, removals);
}

/// 64-bit checksum: each 8 bytes are mixed in by a bijection, so that a change of one word always shows.
class Checksum {
public:
    void add(const void* data, std::size_t bytes) {
        mix(bytes);
        const auto* first = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < bytes; i += 8) {
            std::uint64_t word = 0;
            std::memcpy(&word, first + i, bytes - i < 8 ? bytes - i : 8);
            mix(word);
        }
    }
    std::uint64_t value() const { return state_; }

private:
    void mix(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
        state_ ^= state_ >> 29;
    }
    std::uint64_t state_ = 0x6772616e72617931u;
};

inline std::uint64_t checksum_of(const Checkpoint& c) {
    Checksum sum;
    for_each_number(c, [&](const char*, const auto& value) { sum.add(&value, sizeof value); });
    for_each_array(c, [&](const char*, const auto& array, int) { sum.add(array.data(), array.size() * sizeof array[0]); });
    sum.add(c.scene.data(), c.scene.size());
    return sum.value();
}

}  // namespace grainray
