// Parts of JSON reports that run and bench share.
#pragma once

#include <nlohmann/json.hpp>

#include "grainray/simulation.hpp"

namespace grainray::cli {

nlohmann::ordered_json profile_json(const Profile&);
nlohmann::ordered_json search_json(const SearchReport&);
/// wall_seconds, steps_per_second, particle_steps_per_second
void add_speed(nlohmann::ordered_json&, std::size_t particles, std::uint64_t steps, double wall_seconds);

}  // namespace grainray::cli
