// Parts of JSON reports that run and bench share.
#pragma once

#include <nlohmann/json.hpp>

#include "grainray/simulation.hpp"

namespace grainray::cli {

nlohmann::ordered_json profile_json(const Profile&);
nlohmann::ordered_json search_json(const SearchReport&);
/// wall_seconds, steps_per_second, particle_steps_per_second
void add_speed(nlohmann::ordered_json&, std::uint64_t particle_steps, std::uint64_t steps, double wall_seconds);

/// What all streams and removals have done together.
struct Exchanged {
    std::uint64_t inserted = 0, waiting = 0, removed = 0, lost = 0;  ///< lost: left an open terrain
};
Exchanged exchanged_by(const Simulation&);

}  // namespace grainray::cli
